// Chief rays with their wavefronts, for any number of lanes; included after lens_batch_kernel.inl.
// The path runs from the eye through the back and the front, the wave from the object the same way back
// (docs/decisions/0006-measurement.md).

// Distance between ray and surface, mm, from which the next point is the last: it is then within the square
// of this times the curvature, some 1e-8 mm, and one more step along the tangents leaves nothing of that.
constexpr double kLastButOne_mm = 1e-3;
// What is left at the last point, mm, unless the iteration failed.
constexpr double kLast_mm = 1e-6;

struct Bent {
  Vec p, u, v, uu, uv, vv;
};

struct BentComponent {
  Real p, u, v, uu, uv, vv;
};

// As horner(), with the second derivatives.
template <int P, int Q, class Coefficients>
inline BentComponent bent_horner(const Coefficients& c, int component, const Real& x, const Real& y,
                                 int degree_u, int degree_v) {
  const int p = P > 0 ? P : degree_u, q = Q > 0 ? Q : degree_v;
  BentComponent h{};
  for (int i = p; i >= 0; --i) {
    const int row = i * (q + 1);
    Real value = c(4 * (row + q) + component), slope = splat(0),
         bend = splat(0);  // bend: half the second derivative
    for (int j = q - 1; j >= 0; --j) {
      bend = bend * y + slope;
      slope = slope * y + value;
      value = value * y + c(4 * (row + j) + component);
    }
    h.uu = h.uu * x + h.u;
    h.u = h.u * x + h.p;
    h.p = h.p * x + value;
    h.uv = h.uv * x + h.v;
    h.v = h.v * x + slope;
    h.vv = h.vv * x + bend;
  }
  h.uu = splat(2) * h.uu;
  h.vv = splat(2) * h.vv;
  return h;
}

template <int P, int Q, class Coefficients>
inline Bent bent_components(const Surface& s, const Coefficients& c, const Real& x, const Real& y) {
  const BentComponent a = bent_horner<P, Q>(c, 0, x, y, s.degree_u, s.degree_v),
                      b = bent_horner<P, Q>(c, 1, x, y, s.degree_u, s.degree_v),
                      d = bent_horner<P, Q>(c, 2, x, y, s.degree_u, s.degree_v);
  return {{a.p, b.p, d.p},    {a.u, b.u, d.u},    {a.v, b.v, d.v},
          {a.uu, b.uu, d.uu}, {a.uv, b.uv, d.uv}, {a.vv, b.vv, d.vv}};
}

template <class Coefficients>
inline Bent bent_block(const Surface& s, const Coefficients& c, const Real& x, const Real& y,
                       const Real& rate_u, const Real& rate_v) {
  Bent at = s.degree_u == 3 && s.degree_v == 3   ? bent_components<3, 3>(s, c, x, y)
            : s.degree_u == 5 && s.degree_v == 5 ? bent_components<5, 5>(s, c, x, y)
                                                 : bent_components<-1, -1>(s, c, x, y);
  if (s.rational) {  // Piegl and Tiller, eq. 4.20
    const BentComponent w = bent_horner<-1, -1>(c, 3, x, y, s.degree_u, s.degree_v);
    const Real inverse = splat(1) / w.p;
    at.p = inverse * at.p;
    at.u = inverse * (at.u - w.u * at.p);
    at.v = inverse * (at.v - w.v * at.p);
    at.uu = inverse * (at.uu - splat(2) * w.u * at.u - w.uu * at.p);
    at.uv = inverse * (at.uv - w.u * at.v - w.v * at.u - w.uv * at.p);
    at.vv = inverse * (at.vv - splat(2) * w.v * at.v - w.vv * at.p);
  }
  return {at.p,
          rate_u * at.u,
          rate_v * at.v,
          rate_u * rate_u * at.uu,
          rate_u * rate_v * at.uv,
          rate_v * rate_v * at.vv};
}

inline Bent bent_at(const Surface& s, const Real& u, const Real& v) {
  return in_spans(s, u, v,
                  [&s](const auto& c, const Real& x, const Real& y, const Real& rate_u, const Real& rate_v) {
                    return bent_block(s, c, x, y, rate_u, rate_v);
                  });
}

struct Step {
  Real u, v;
  Real distance2;  // of ray and point, squared
};

// The step along the tangents `u`, `v` at the point `p` of a surface to the ray from `start` along `d`:
// start + t d - p = a u + b v; with w = d x (start - p), a = v.w / n.d and b = -u.w / n.d.
inline Step step_to(const Vec& start, const Vec& d, const Vec& p, const Vec& u, const Vec& v) {
  const Vec w = cross(d, start - p);
  const Real inverse = splat(1) / dot(cross(u, v), d);
  return {dot(v, w) * inverse, splat(0) - dot(u, w) * inverse, dot(w, w)};
}

struct WaveHit {
  Vec point;  // relative to the surface's origin
  Vec normal;
  Bent at;
  Real u, v;
  Mask found;
};

inline Mask on_surface(const Surface& s, const Real& u, const Real& v) {
  const double edge_u = 1e-9 * (s.u.end - s.u.begin), edge_v = 1e-9 * (s.v.end - s.v.begin);
  return (u >= splat(s.u.begin - edge_u)) & (u <= splat(s.u.end + edge_u)) &
         (v >= splat(s.v.begin - edge_v)) & (v <= splat(s.v.end + edge_v));
}

// Each lane takes the steps that it would take alone, so results do not depend on its neighbours.
inline WaveHit wave_hit(const Surface& s, const Vec& origin, const Vec& d) {
  const double slack_u = 0.5 * (s.u.end - s.u.begin), slack_v = 0.5 * (s.v.end - s.v.begin);
  const Start begin = start_on(s, origin, d, 3);
  const Vec& start = begin.point;
  Real u = begin.u, v = begin.v;
  Mask moving = splat(0) == splat(0), nearby = splat(0) != splat(0);
  for (int iteration = 0; iteration <= kMaxIterations; ++iteration) {
    const Point at = evaluate(s, u, v);
    const Step step = step_to(start, d, at.p, at.u, at.v);
    nearby = step.distance2 <= splat(kLastButOne_mm * kLastButOne_mm);
    u = moving ? clamp(u + step.u, s.u.begin - slack_u, s.u.end + slack_u) : u;
    v = moving ? clamp(v + step.v, s.v.begin - slack_v, s.v.end + slack_v) : v;
    moving = moving & (step.distance2 > splat(kLastButOne_mm * kLastButOne_mm));
    if (all(nearby)) break;
  }
  Bent at = bent_at(s, u, v);
  const Step step = step_to(start, d, at.p, at.u, at.v);
  at.u = at.u + step.u * at.uu + step.v * at.uv;
  at.v = at.v + step.u * at.uv + step.v * at.vv;
  const Vec n = cross(at.u, at.v);
  const Mask found = (step.distance2 <= splat(kLast_mm * kLast_mm)) & on_surface(s, u + step.u, v + step.v);
  return {at.p + step.u * at.u + step.v * at.v,
          (splat(s.orientation) / root(dot(n, n))) * n,
          at,
          u + step.u,
          v + step.v,
          found};
}

// A wave on the dual basis of a surface's tangents and its own direction: uu eu eu + uv (eu ev + ev eu) + vv
// ev ev.
struct Wave {
  Real uu, uv, vv;
  Vec eu, ev;
};

inline Wave wave_from(const Bent& at, const Vec& out, const Real& uu, const Real& uv, const Real& vv) {
  const Real inverse = splat(1) / dot(cross(at.u, at.v), out);
  return {uu, uv, vv, inverse * cross(at.v, out), inverse * cross(out, at.u)};
}

// The wave of a point at distance 1 / curvature, after refraction of `d` into `out`.
inline Wave wave_entered(const Bent& at, const Vec& d, const Vec& out, double eta, double curvature) {
  const Vec k = splat(eta) * d - out;
  const Real du = dot(d, at.u), dv = dot(d, at.v), c = splat(eta * curvature);
  return wave_from(at, out, c * (dot(at.u, at.u) - du * du) + dot(k, at.uu),
                   c * (dot(at.u, at.v) - du * dv) + dot(k, at.uv),
                   c * (dot(at.v, at.v) - dv * dv) + dot(k, at.vv));
}

// The wave `length` further along `d`, refracted there into `out`: transferred() and refracted() of
// wavefront.h in one.
inline Wave wave_left(const Wave& wave, const Real& length, const Bent& at, const Vec& d, const Vec& out,
                      double eta) {
  const Real g11 = dot(wave.eu, wave.eu), g12 = dot(wave.eu, wave.ev), g22 = dot(wave.ev, wave.ev);
  const Real trace = wave.uu * g11 + splat(2) * wave.uv * g12 + wave.vv * g22;
  const Real minors = (wave.uu * wave.vv - wave.uv * wave.uv) * (g11 * g22 - g12 * g12);
  const Real scale = splat(eta) / (splat(1) + length * (trace + length * minors)), spread = length * minors;
  const Real uu = dot(wave.eu, at.u), vu = dot(wave.ev, at.u), uv = dot(wave.eu, at.v),
             vv = dot(wave.ev, at.v);
  const Real du = dot(d, at.u), dv = dot(d, at.v);
  const auto moved = [&](const Real& ar, const Real& br, const Real& as, const Real& bs, const Real& across) {
    return scale * (wave.uu * ar * as + wave.uv * (ar * bs + br * as) + wave.vv * br * bs + spread * across);
  };
  const Vec k = splat(eta) * d - out;
  return wave_from(at, out, moved(uu, vu, uu, vu, dot(at.u, at.u) - du * du) + dot(k, at.uu),
                   moved(uu, vu, uv, vv, dot(at.u, at.v) - du * dv) + dot(k, at.uv),
                   moved(uv, vv, uv, vv, dot(at.v, at.v) - dv * dv) + dot(k, at.vv));
}

struct Colour {
  Vec object_side;
  Real u, v;
  Mask possible;
};

// The object side of the ray of another index: its hit on the front starts from that of the first, to second
// order.
inline Colour coloured(const WaveLens& lens, const WaveHit& back, const WaveHit& front, const Vec& eye_side,
                       const Vec& start, double eta) {
  const Refraction inside = refract_at(eye_side, back.normal, eta);
  const Vec& d = inside.direction;
  Step step = step_to(start, d, front.point, front.at.u, front.at.v);
  const auto bend = [&](const Real& a, const Real& b) {
    return splat(0.5) * a * a * front.at.uu + a * b * front.at.uv + splat(0.5) * b * b * front.at.vv;
  };
  const Vec second = front.point + step.u * front.at.u + step.v * front.at.v + bend(step.u, step.v);
  const Step more = step_to(start, d, second, front.at.u, front.at.v);
  Real u = clamp(front.u + step.u + more.u, lens.front.u.begin, lens.front.u.end),
       v = clamp(front.v + step.v + more.v, lens.front.v.begin, lens.front.v.end);
  const Point at = evaluate(lens.front, u, v);
  step = step_to(start, d, at.p, at.u, at.v);
  const Vec n = cross(at.u + step.u * front.at.uu + step.v * front.at.uv,
                      at.v + step.u * front.at.uv + step.v * front.at.vv);
  const Refraction outside = refract_at(d, (splat(-lens.front.orientation) / root(dot(n, n))) * n, 1 / eta);
  u = u + step.u;
  v = v + step.v;
  const Mask met = inside.possible & outside.possible & (step.distance2 <= splat(kLast_mm * kLast_mm)) &
                   on_surface(lens.front, u, v);
  return {outside.direction, u, v, met};
}

inline void trace_waves(const WaveLens& lens, const WaveRays& rays) {
  const Vec back_origin = constant(lens.back.origin), to_front = back_origin - constant(lens.front.origin);
  for (std::size_t first = 0; first < rays.count; first += kLanes) {
    const std::size_t left = rays.count - first;
    const auto read = [&](int k) { return load(rays.ray[k] + first, left); };
    const auto write = [&](double* const(&to)[3], const Vec& value) {
      store(to[0] + first, value.x, left);
      store(to[1] + first, value.y, left);
      store(to[2] + first, value.z, left);
    };
    const Vec from = Vec{read(0), read(1), read(2)} - back_origin;
    Vec eye_side{read(3), read(4), read(5)};

    const WaveHit back = wave_hit(lens.back, from, eye_side);
    Mask clear =
        back.found & (dot(back.normal, eye_side) < splat(0)) & (dot(back.point - from, eye_side) >= splat(0));
    if (lens.along_normal) eye_side = splat(-1) * back.normal;
    const Refraction inside = refract_at(eye_side, back.normal, lens.eta);

    const Vec start = back.point + to_front;
    const WaveHit front = wave_hit(lens.front, start, inside.direction);
    const Real length = dot(front.point - start, inside.direction);
    const Refraction outside = refract_at(inside.direction, splat(-1) * front.normal, 1 / lens.eta);
    clear = clear & inside.possible & front.found & (dot(front.normal, inside.direction) > splat(0)) &
            (length >= splat(0)) & outside.possible;

    const Vec light = splat(-1) * inside.direction, leaving = splat(-1) * eye_side;
    const Wave entered =
        wave_entered(front.at, splat(-1) * outside.direction, light, lens.eta, lens.object_curvature);
    const Wave wave = wave_left(entered, length, back.at, light, leaving, 1 / lens.eta);
    const auto entry = [&](const Real& eu, const Real& ev, const Real& fu, const Real& fv) {
      return wave.uu * eu * fu + wave.uv * (eu * fv + ev * fu) + wave.vv * ev * fv;
    };
    const Vec &eu = wave.eu, &ev = wave.ev;
    store(rays.wave[0] + first, entry(eu.x, ev.x, eu.x, ev.x), left);
    store(rays.wave[1] + first, entry(eu.x, ev.x, eu.y, ev.y), left);
    store(rays.wave[2] + first, entry(eu.x, ev.x, eu.z, ev.z), left);
    store(rays.wave[3] + first, entry(eu.y, ev.y, eu.y, ev.y), left);
    store(rays.wave[4] + first, entry(eu.y, ev.y, eu.z, ev.z), left);
    store(rays.wave[5] + first, entry(eu.z, ev.z, eu.z, ev.z), left);
    write(rays.back, back.point + back_origin);
    write(rays.eye_side, eye_side);
    write(rays.object_side, outside.direction);
    const Real* const uv[4] = {&back.u, &back.v, &front.u, &front.v};
    for (int k = 0; k < 4; ++k) store(rays.uv[k] + first, *uv[k], left);

    if (lens.coloured) {
      const Colour f = coloured(lens, back, front, eye_side, start, lens.eta_f),
                   c = coloured(lens, back, front, eye_side, start, lens.eta_c);
      clear = clear & f.possible & c.possible;
      write(rays.colour_f, f.object_side);
      write(rays.colour_c, c.object_side);
      const Real* const colours[4] = {&f.u, &f.v, &c.u, &c.v};
      for (int k = 0; k < 4; ++k) store(rays.uv_colour[k] + first, *colours[k], left);
    }
    for (std::size_t i = 0; i < kLanes && i < left; ++i)
      rays.outcome[first + i] = lane(clear, int(i)) ? kPassed : kUnclear;
  }
}
