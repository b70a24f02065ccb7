// Four doubles that are added and multiplied together, in the two-wide registers every x86-64 and AArch64
// machine has.
#pragma once

#include <cstring>
#include <glm/vec4.hpp>

namespace catoptra::cad_import {

/// x, y, z, w. Written out because compilers turn only some of the evaluator's loops over glm::dvec4 into
/// vector instructions; the results are the same to the last bit, lane by lane.
struct Lanes {
  typedef double Pair __attribute__((vector_size(16)));
  Pair xy{0, 0}, zw{0, 0};

  Lanes() = default;
  Lanes(Pair first, Pair second) : xy(first), zw(second) {}
  explicit Lanes(const glm::dvec4& v) {
    std::memcpy(&xy, &v.x, sizeof xy);
    std::memcpy(&zw, &v.z, sizeof zw);
  }
  explicit operator glm::dvec4() const { return {xy[0], xy[1], zw[0], zw[1]}; }
  [[nodiscard]] double w() const { return zw[1]; }

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return {a.xy + b.xy, a.zw + b.zw}; }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return {a.xy - b.xy, a.zw - b.zw}; }
  friend Lanes operator*(const Lanes& a, double s) { return {a.xy * s, a.zw * s}; }
  friend Lanes operator*(double s, const Lanes& a) { return a * s; }
  Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  Lanes& operator*=(double s) { return *this = *this * s; }
};

}  // namespace catoptra::cad_import
