#include "optics/wavefront.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace catoptra::optics {
namespace {

// The part of the identity across the unit vector `d`.
glm::dmat3 across(const glm::dvec3& d) {
  return glm::dmat3(1) - glm::outerProduct(d, d);
}

// The wave along `out` with the second derivatives q_ij = Q'(r_i, r_j) along the surface: sum of q_ij e^i e^j
// over the dual basis of (r_u, r_v, out).
Wavefront from_surface(double quu, double quv, double qvv, const glm::dvec3& out,
                       const cad_import::SurfaceDerivatives& s) {
  const double inverse = 1 / glm::dot(glm::cross(s.du, s.dv), out);
  const glm::dvec3 eu = glm::cross(s.dv, out) * inverse, ev = glm::cross(out, s.du) * inverse;
  const glm::dmat3 mixed = glm::outerProduct(eu, ev);
  return {quu * glm::outerProduct(eu, eu) + quv * (mixed + glm::transpose(mixed)) +
          qvv * glm::outerProduct(ev, ev)};
}

}  // namespace

Wavefront spherical_wavefront(const glm::dvec3& d, double distance_mm) {
  return {across(d) * (1 / distance_mm)};
}

// Q d = 0 makes the inverse that of a 2 x 2 matrix: with m the sum of Q's principal minors (the product of
// its two other eigenvalues), Q (I + L Q)^-1 = (Q + L m P) / (1 + L tr Q + L^2 m), P the part of I across d.
Wavefront transferred(const Wavefront& wave, const glm::dvec3& d, double length_mm) {
  const glm::dmat3& q = wave.curvature;
  const double trace = q[0][0] + q[1][1] + q[2][2];
  const double minors = q[0][0] * q[1][1] - q[0][1] * q[1][0] + q[1][1] * q[2][2] - q[1][2] * q[2][1] +
                        q[2][2] * q[0][0] - q[2][0] * q[0][2];
  const double scale = 1 / (1 + length_mm * (trace + length_mm * minors));
  return {(q + length_mm * minors * across(d)) * scale};
}

// Phase n (d . r + Q(r, r) / 2) is the same on both sides along the surface, to second order.
Wavefront refracted(const Wavefront& wave, const glm::dvec3& d, const glm::dvec3& out, double eta,
                    const cad_import::SurfaceDerivatives& surface) {
  const glm::dvec3 qu = wave.curvature * surface.du, qv = wave.curvature * surface.dv, k = eta * d - out;
  return from_surface(eta * glm::dot(surface.du, qu) + glm::dot(k, surface.duu),
                      eta * glm::dot(surface.du, qv) + glm::dot(k, surface.duv),
                      eta * glm::dot(surface.dv, qv) + glm::dot(k, surface.dvv), out, surface);
}

Wavefront reflected(const Wavefront& wave, const glm::dvec3& d, const glm::dvec3& out,
                    const cad_import::SurfaceDerivatives& surface) {
  return refracted(wave, d, out, 1, surface);
}

}  // namespace catoptra::optics
