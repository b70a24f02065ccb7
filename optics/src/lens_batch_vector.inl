// What the vector units have in common, for a file that has defined Real, Index and kLanes; included before
// the kernel.

inline Real splat(double x) {
  return Real{} + x;
}
inline Real load(const double* from, std::size_t left) {
  Real x;
  if (left >= std::size_t(kLanes)) {
    __builtin_memcpy(&x, from, sizeof(x));
    return x;
  }
  for (int i = 0; i < kLanes; ++i) x[i] = from[std::size_t(i) < left ? std::size_t(i) : left - 1];
  return x;
}
inline void store(double* to, const Real& x, std::size_t left) {
  if (left >= std::size_t(kLanes)) {
    __builtin_memcpy(to, &x, sizeof(x));
    return;
  }
  for (int i = 0; i < kLanes && std::size_t(i) < left; ++i) to[i] = x[i];
}
inline double lane(const Real& x, int i) {
  return x[i];
}
inline std::int64_t lane(const Index& x, int i) {
  return x[i];
}
inline void set_lane(Index& x, int i, std::int64_t value) {
  x[i] = value;
}
