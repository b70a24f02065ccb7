// The batch kernel, written once for any number of lanes. Each including file names its vector type:
// Real, Index, Mask, kLanes and the functions splat, load, root, gather, all.
// Two surfaces, two Snell refractions; Newton on surface(u, v) = origin + t direction in both unknowns.

constexpr int kMaxIterations = 10;
// Distance between ray and surface, mm, from which one more step without evaluation is exact: the point to
// 1e-22 and the normal to 1e-11 mm times the curvature.
constexpr double kConverged_mm = 1e-11;

struct Vec {
  Real x, y, z;
};

inline Vec operator+(const Vec& a, const Vec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator-(const Vec& a, const Vec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec operator*(const Real& s, const Vec& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline Real dot(const Vec& a, const Vec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec constant(const double* v) {
  return {splat(v[0]), splat(v[1]), splat(v[2])};
}
inline Real clamp(const Real& x, double low, double high) {
  const Real above = x < splat(low) ? splat(low) : x;
  return above > splat(high) ? splat(high) : above;
}

inline std::int32_t span_of(const Axis& axis, double t) {
  const double position = (t - axis.bucket_begin) * axis.bucket_rate;
  std::int32_t b =
      position > 0 ? (position < axis.bucket_count ? std::int32_t(position) : axis.bucket_count - 1) : 0;
  std::int32_t s = axis.bucket[b];
  while (t < axis.low[s]) --s;
  while (t >= axis.high[s]) ++s;
  return s;
}

// Coefficients of one span for all lanes.
struct Broadcast {
  const double* block;
  Real operator()(int k) const { return splat(block[k]); }
};

// Coefficients of two spans: neighbouring rays on both sides of a knot, far cheaper than gathering.
struct TwoSpans {
  const double *first, *second;
  Mask in_first;
  Real operator()(int k) const { return in_first ? splat(first[k]) : splat(second[k]); }
};

// Coefficients of each lane's own span.
struct Gather {
  const double* base;
  Index offset;
  Real operator()(int k) const { return gather(base + k, offset); }
};

struct Point {
  Vec p, u, v;  // relative to the surface's origin; derivatives by u and v
};

// Value and both derivatives of one component by Horner's scheme, over v in every row and then over u. P and
// Q are the degrees where they are known when compiling, else -1.
struct Component {
  Real p, u, v;
};

template <int P, int Q, class Coefficients>
inline Component horner(const Coefficients& c, int component, const Real& x, const Real& y, int degree_u,
                        int degree_v) {
  const int p = P > 0 ? P : degree_u, q = Q > 0 ? Q : degree_v;
  Component h{};
  for (int i = p; i >= 0; --i) {
    const int row = i * (q + 1);
    Real slope = c(4 * (row + q) + component);
    Real value = slope * y + c(4 * (row + q - 1) + component);
    for (int j = q - 2; j >= 0; --j) {
      slope = slope * y + value;
      value = value * y + c(4 * (row + j) + component);
    }
    if (i == p) {
      h = {value, splat(0), slope};
      continue;
    }
    h.u = i == p - 1 ? h.p : h.u * x + h.p;
    h.p = h.p * x + value;
    h.v = h.v * x + slope;
  }
  return h;
}

template <class Coefficients>
inline Point evaluate_block(const Surface& s, const Coefficients& c, const Real& x, const Real& y,
                            const Real& rate_u, const Real& rate_v) {
  if (!s.rational && s.degree_u == 3 && s.degree_v == 3) {
    const Component a = horner<3, 3>(c, 0, x, y, 3, 3), b = horner<3, 3>(c, 1, x, y, 3, 3),
                    d = horner<3, 3>(c, 2, x, y, 3, 3);
    return {{a.p, b.p, d.p},
            {a.u * rate_u, b.u * rate_u, d.u * rate_u},
            {a.v * rate_v, b.v * rate_v, d.v * rate_v}};
  }
  const Component a = horner<-1, -1>(c, 0, x, y, s.degree_u, s.degree_v),
                  b = horner<-1, -1>(c, 1, x, y, s.degree_u, s.degree_v),
                  d = horner<-1, -1>(c, 2, x, y, s.degree_u, s.degree_v);
  Point at{{a.p, b.p, d.p}, {a.u, b.u, d.u}, {a.v, b.v, d.v}};
  if (s.rational) {  // Piegl and Tiller, eq. 4.20
    const Component w = horner<-1, -1>(c, 3, x, y, s.degree_u, s.degree_v);
    const Real inverse = splat(1) / w.p;
    at.p = inverse * at.p;
    at.u = inverse * (at.u - w.u * at.p);
    at.v = inverse * (at.v - w.v * at.p);
  }
  return {at.p, rate_u * at.u, rate_v * at.v};
}

// Calls `block` with the coefficients of every lane's span, the local parameters and their rates.
template <class Block>
inline auto in_spans(const Surface& s, const Real& u, const Real& v, const Block& block) {
  const std::int32_t size = 4 * (s.degree_u + 1) * (s.degree_v + 1);
  const std::int32_t su = span_of(s.u, lane(u, 0)), sv = span_of(s.v, lane(v, 0));
  const Mask one_span = (u >= splat(s.u.low[su])) & (u < splat(s.u.high[su])) & (v >= splat(s.v.low[sv])) &
                        (v < splat(s.v.high[sv]));
  if (kLanes == 1 || all(one_span)) {
    const Real rate_u = splat(s.u.rate[su]), rate_v = splat(s.v.rate[sv]);
    const Real x = (u - splat(s.u.middle[su])) * rate_u, y = (v - splat(s.v.middle[sv])) * rate_v;
    const Broadcast c{s.coefficients + std::size_t(su * s.spans_v + sv) * std::size_t(size)};
    return block(c, x, y, rate_u, rate_v);
  }
  // The lanes are in different spans.
  Index spans_u{}, spans_v{};
  for (int i = 0; i < kLanes; ++i) {
    set_lane(spans_u, i, span_of(s.u, lane(u, i)));
    set_lane(spans_v, i, span_of(s.v, lane(v, i)));
  }
  const Index offset = (spans_u * s.spans_v + spans_v) * size;
  const Real rate_u = gather(s.u.rate, spans_u), rate_v = gather(s.v.rate, spans_v);
  const Real x = (u - gather(s.u.middle, spans_u)) * rate_u, y = (v - gather(s.v.middle, spans_v)) * rate_v;
  const std::int64_t first = lane(offset, 0);
  std::int64_t second = first;
  for (int i = 1; i < kLanes; ++i)
    if (lane(offset, i) != first) second = lane(offset, i);
  const Mask in_first = offset == first;
  if (all(in_first | (offset == second)))
    return block(TwoSpans{s.coefficients + first, s.coefficients + second, in_first}, x, y, rate_u, rate_v);
  return block(Gather{s.coefficients, offset}, x, y, rate_u, rate_v);
}

inline Point evaluate(const Surface& s, const Real& u, const Real& v) {
  return in_spans(s, u, v,
                  [&s](const auto& c, const Real& x, const Real& y, const Real& rate_u, const Real& rate_v) {
                    return evaluate_block(s, c, x, y, rate_u, rate_v);
                  });
}

struct SurfaceHit {
  Vec point;   // relative to the surface's origin
  Vec normal;  // unit, out of the lens
  Real u, v;
  Mask found;
};

// Where a search for the hit of a ray starts: near it, on the ray and in parameters.
struct Start {
  Vec point;
  Real u, v;
};

// Where the ray meets the plane through the surface's middle, then `steps` times towards the height there: rays that run more
// along the plane need more. `origin` is relative to the surface's.
inline Start start_on(const Surface& s, const Vec& origin, const Vec& d, int steps) {
  const Vec plane = constant(s.plane_point), n0 = constant(s.normal), ex = constant(s.axis_x),
            ey = constant(s.axis_y);
  const Vec from = origin - plane;
  const Real inverse_slope = splat(1) / dot(n0, d);
  const Real along_x = dot(ex, d), along_y = dot(ey, d), x0 = dot(ex, from), y0 = dot(ey, from),
             z0 = dot(n0, from);
  Real t = splat(0) - z0 * inverse_slope, x = x0 + t * along_x, y = y0 + t * along_y;
  for (int k = 0; k < steps; ++k) {
    const Real height = splat(s.height[0]) +
                        x * (splat(s.height[1]) + splat(s.height[3]) * x + splat(s.height[4]) * y) +
                        y * (splat(s.height[2]) + splat(s.height[5]) * y);
    t = (height - z0) * inverse_slope;
    x = x0 + t * along_x;
    y = y0 + t * along_y;
  }
  return {origin + t * d,
          clamp(splat(s.start_u[0]) + splat(s.start_u[1]) * x + splat(s.start_u[2]) * y, s.u.begin, s.u.end),
          clamp(splat(s.start_v[0]) + splat(s.start_v[1]) * x + splat(s.start_v[2]) * y, s.v.begin, s.v.end)};
}

// `origin` relative to the surface's.
inline SurfaceHit hit_surface(const Surface& s, const Vec& origin, const Vec& d) {
  const double slack_u = 0.5 * (s.u.end - s.u.begin), slack_v = 0.5 * (s.v.end - s.v.begin);
  const Start begin = start_on(s, origin, d, 1);
  const Vec& start = begin.point;
  Real u = begin.u, v = begin.v;

  // q + t d = a S_u + b S_v: with w = d x q, a = S_v.w / n.d and b = -S_u.w / n.d; |w| is the distance of ray
  // and surface point.
  Point at{};
  Vec n{};
  Real step_u{}, step_v{};
  Mask found{};
  for (int iteration = 0; iteration <= kMaxIterations; ++iteration) {
    at = evaluate(s, u, v);
    n = cross(at.u, at.v);
    const Vec w = cross(d, start - at.p);
    const Real inverse = splat(1) / dot(n, d);
    step_u = dot(at.v, w) * inverse;
    step_v = splat(0) - dot(at.u, w) * inverse;
    found = dot(w, w) <= splat(kConverged_mm * kConverged_mm);
    if (all(found)) break;
    u = clamp(u + step_u, s.u.begin - slack_u, s.u.end + slack_u);
    v = clamp(v + step_v, s.v.begin - slack_v, s.v.end + slack_v);
  }
  const Real end_u = u + step_u, end_v = v + step_v;
  const double edge_u = 2e-9 * slack_u, edge_v = 2e-9 * slack_v;  // as newton_hit: the border belongs to it
  found = found & (end_u >= splat(s.u.begin - edge_u)) & (end_u <= splat(s.u.end + edge_u)) &
          (end_v >= splat(s.v.begin - edge_v)) & (end_v <= splat(s.v.end + edge_v));
  return {at.p + step_u * at.u + step_v * at.v, (splat(s.orientation) / root(dot(n, n))) * n, end_u, end_v,
          found};
}

struct Refraction {
  Vec direction;
  Mask possible;
  Real transmittance;
};

// Snell and Fresnel at the normal `n` against `d`; eta = n_from / n_to.
inline Refraction refract_at(const Vec& d, const Vec& n, double eta) {
  const Real cos_in = splat(0) - dot(n, d),
             square = splat(1) - splat(eta * eta) * (splat(1) - cos_in * cos_in);
  const Mask possible = square >= splat(0);
  const Real cos_out = root(possible ? square : splat(0));
  const Real s = (splat(eta) * cos_in - cos_out) / (splat(eta) * cos_in + cos_out);
  const Real p = (cos_in - splat(eta) * cos_out) / (cos_in + splat(eta) * cos_out);
  return {splat(eta) * d + (splat(eta) * cos_in - cos_out) * n, possible,
          splat(1) - splat(0.5) * (s * s + p * p)};
}

inline void trace(const Lens& lens, const Rays& rays) {
  const Vec to_exit = constant(lens.entry.origin) - constant(lens.exit.origin);
  const Vec entry_origin = constant(lens.entry.origin), exit_origin = constant(lens.exit.origin);
  for (std::size_t first = 0; first < rays.count; first += kLanes) {
    const std::size_t left = rays.count - first;
    const auto read = [&](const double* from) { return load(from + first, left); };
    const auto write = [&](double* to, const Real& value) { store(to + first, value, left); };
    const Vec d{read(rays.direction_x), read(rays.direction_y), read(rays.direction_z)};
    const Vec eye{read(rays.origin_x), read(rays.origin_y), read(rays.origin_z)};

    const SurfaceHit in = hit_surface(lens.entry, eye - entry_origin, d);
    const Refraction inside = refract_at(d, in.normal, lens.eta);
    const SurfaceHit out = hit_surface(lens.exit, in.point + to_exit, inside.direction);
    const Refraction outside = refract_at(inside.direction, splat(-1) * out.normal, 1 / lens.eta);

    // Met in the order of a lens: the entry from outside and not behind the ray's start, then the exit from
    // within.
    const Mask entered =
        in.found & (dot(in.normal, d) < splat(0)) & (dot(in.point - (eye - entry_origin), d) >= splat(0));
    const Mask crossed = out.found & (dot(out.normal, inside.direction) > splat(0)) &
                         (dot(out.point - (in.point + to_exit), inside.direction) >= splat(0));
    const Mask clear = entered & inside.possible & crossed;
    const Vec exit = out.point + exit_origin;
    write(rays.exit_x, exit.x);
    write(rays.exit_y, exit.y);
    write(rays.exit_z, exit.z);
    write(rays.outside_x, outside.direction.x);
    write(rays.outside_y, outside.direction.y);
    write(rays.outside_z, outside.direction.z);
    write(rays.transmittance, inside.transmittance * outside.transmittance);
    write(rays.entry_u, in.u);
    write(rays.entry_v, in.v);
    write(rays.exit_u, out.u);
    write(rays.exit_v, out.v);
    for (std::size_t i = 0; i < kLanes && i < left; ++i)
      rays.outcome[first + i] = !lane(clear, int(i))             ? kUnclear
                                : lane(outside.possible, int(i)) ? kPassed
                                                                 : kTotalReflection;
  }
}
