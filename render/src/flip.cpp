#include "render/src/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace catoptra::render {
namespace {

// Names and constants as in the paper, sections 4.1 to 4.3.
constexpr float kQc = 0.7f, kPc = 0.4f, kPt = 0.95f;  // colour: compression, and where its linear part ends
constexpr float kQf = 0.5f;                           // features: exponent
constexpr double kFeatureWidthDeg = 0.082;            // of the edges and points that the eye finds

using Plane = std::vector<float>;
using Kernel = std::vector<float>;  ///< 2 radius + 1 weights

struct Size {
  int width, height;
  [[nodiscard]] std::size_t count() const { return std::size_t(width) * std::size_t(height); }
};

/// Linear sRGB to CIE XYZ, rows (IEC 61966-2-1; the fractions follow from the primaries and D65).
const glm::mat3& rgb_to_xyz() {
  static const glm::mat3 matrix(
      glm::transpose(glm::dmat3(10135552 / 24577794.0, 8788810 / 24577794.0, 4435075 / 24577794.0,  //
                                2613072 / 12288897.0, 8788810 / 12288897.0, 887015 / 12288897.0,    //
                                1425312 / 73733382.0, 8788810 / 73733382.0, 70074185 / 73733382.0)));
  return matrix;
}

glm::vec3 white_xyz() {
  return rgb_to_xyz() * glm::vec3(1);
}

/// The opponent space in which the contrast sensitivity of the eye is known: linear in XYZ.
glm::vec3 to_ycxcz(const glm::vec3& linear) {
  const glm::vec3 n = (rgb_to_xyz() * linear) / white_xyz();
  return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}

glm::vec3 from_ycxcz(const glm::vec3& c) {
  static const glm::mat3 xyz_to_rgb = glm::inverse(rgb_to_xyz());
  const float y = (c.x + 16) / 116;
  return xyz_to_rgb * (glm::vec3(y + c.y / 500, y, y - c.z / 200) * white_xyz());
}

/// CIELAB with the Hunt effect: chroma counts less in the dark.
glm::vec3 to_hunt_lab(const glm::vec3& linear) {
  const glm::vec3 n = (rgb_to_xyz() * linear) / white_xyz();
  const auto f = [](float t) {
    constexpr float delta = 6.0f / 29.0f;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29.0f;
  };
  const float l = 116 * f(n.y) - 16;
  return {l, 0.01f * l * 500 * (f(n.x) - f(n.y)), 0.01f * l * 200 * (f(n.y) - f(n.z))};
}

/// The colour distance for large differences: city-block in lightness, Euclidean in chroma.
float hyab(const glm::vec3& a, const glm::vec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// Weights of exp(-x^2 / (2 sigma^2)), sum 1.
Kernel gaussian(double sigma, int radius) {
  Kernel k;
  double sum = 0;
  for (int x = -radius; x <= radius; ++x) sum += std::exp(-x * x / (2 * sigma * sigma));
  for (int x = -radius; x <= radius; ++x) k.push_back(float(std::exp(-x * x / (2 * sigma * sigma)) / sum));
  return k;
}

/// Derivative of a Gaussian of order 1 (edges) or 2 (points): positive weights add up to 1, negative ones to
/// -1.
Kernel derivative(double sigma, int radius, int order) {
  std::vector<double> k;
  double positive = 0, negative = 0;
  for (int x = -radius; x <= radius; ++x) {
    const double g = std::exp(-x * x / (2 * sigma * sigma));
    k.push_back(order == 1 ? -x * g : (x * x / (sigma * sigma) - 1) * g);
    (k.back() > 0 ? positive : negative) += k.back();
  }
  Kernel normalised;
  for (const double w : k) normalised.push_back(float(w > 0 ? w / positive : -w / negative));
  return normalised;
}

/// Convolves rows with `across` and columns with `down`; beyond the border the border's pixels repeat.
Plane convolve(const Plane& in, Size size, const Kernel& across, const Kernel& down) {
  const int rx = int(across.size() / 2), ry = int(down.size() / 2);
  Plane middle(size.count()), out(size.count());
  tbb::parallel_for(0, size.height, [&](int y) {
    const float* row = &in[std::size_t(y) * std::size_t(size.width)];
    for (int x = 0; x < size.width; ++x) {
      float sum = 0;
      for (int k = -rx; k <= rx; ++k)
        sum += across[std::size_t(k + rx)] * row[std::clamp(x + k, 0, size.width - 1)];
      middle[std::size_t(y) * std::size_t(size.width) + std::size_t(x)] = sum;
    }
  });
  tbb::parallel_for(0, size.height, [&](int y) {
    float* row = &out[std::size_t(y) * std::size_t(size.width)];
    for (int k = -ry; k <= ry; ++k) {
      const float* from =
          &middle[std::size_t(std::clamp(y + k, 0, size.height - 1)) * std::size_t(size.width)];
      for (int x = 0; x < size.width; ++x) row[x] += down[std::size_t(k + ry)] * from[x];
    }
  });
  return out;
}

/// A contrast sensitivity function as a sum of two Gaussians in the spatial domain (paper, table 1):
/// amplitude a, width b.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivity{
    {{1, 0.0047, 0, 1e-5},
     {1, 0.0053, 0, 1e-5},
     {34.1, 0.04, 13.5, 0.025}}};  // achromatic, red-green, blue-yellow

/// Blurs one channel as the eye does at this distance.
Plane see(const Plane& in, Size size, const Sensitivity& s, double pixels_per_degree) {
  constexpr double pi = std::numbers::pi;
  const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree));
  // a sqrt(pi / b) exp(-pi^2 d^2 / b) is a Gaussian of this sigma in pixels; its weight is its sum over the
  // kernel.
  const auto sigma = [&](double b) { return std::sqrt(b / (2 * pi * pi)) * pixels_per_degree; };
  const auto weight = [&](double a, double b) {
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) sum += std::exp(-x * x / (2 * sigma(b) * sigma(b)));
    return a * std::sqrt(pi / b) * sum * sum;
  };
  const double w1 = weight(s.a1, s.b1), w2 = weight(s.a2, s.b2);
  const Kernel k1 = gaussian(sigma(s.b1), radius);
  Plane out = convolve(in, size, k1, k1);
  if (w2 <= 0) return out;
  const Kernel k2 = gaussian(sigma(s.b2), radius);
  const Plane second = convolve(in, size, k2, k2);
  const auto share = float(w1 / (w1 + w2));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = share * out[i] + (1 - share) * second[i];
  return out;
}

/// A picture as its viewer perceives it.
struct Percept {
  std::vector<glm::vec3> color;  ///< Hunt-adjusted CIELAB after the eye's blur
  Plane edge, point;             ///< strength of edges and points
};

Percept perceive(std::span<const glm::vec4> linear, Size size, double pixels_per_degree) {
  std::array<Plane, 3> channels;
  for (Plane& c : channels) c.resize(size.count());
  for (std::size_t i = 0; i < size.count(); ++i) {
    const glm::vec3 c = to_ycxcz(glm::clamp(glm::vec3(linear[i]), glm::vec3(0), glm::vec3(1)));
    for (int k = 0; k < 3; ++k) channels[std::size_t(k)][i] = c[k];
  }
  Percept percept;
  Plane luminance = channels[0];
  for (float& y : luminance) y = (y + 16) / 116;
  const double sigma = 0.5 * kFeatureWidthDeg * pixels_per_degree;
  const int radius = int(std::ceil(3 * sigma));
  const Kernel smooth = gaussian(sigma, radius);
  const auto strength = [&](const Kernel& k) {
    Plane x = convolve(luminance, size, k, smooth);
    const Plane y = convolve(luminance, size, smooth, k);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::hypot(x[i], y[i]);
    return x;
  };
  percept.edge = strength(derivative(sigma, radius, 1));
  percept.point = strength(derivative(sigma, radius, 2));
  for (std::size_t k = 0; k < 3; ++k)
    channels[k] = see(channels[k], size, kSensitivity[k], pixels_per_degree);
  percept.color.resize(size.count());
  for (std::size_t i = 0; i < size.count(); ++i) {
    const glm::vec3 rgb = from_ycxcz({channels[0][i], channels[1][i], channels[2][i]});
    percept.color[i] = to_hunt_lab(glm::clamp(rgb, glm::vec3(0), glm::vec3(1)));
  }
  return percept;
}

/// Maps the compressed colour distance to [0, 1]: large differences share the last 5 %.
float redistribute(float difference, float largest) {
  const float knee = kPc * largest;
  if (difference < knee) return kPt / knee * difference;
  return kPt + (difference - knee) / (largest - knee) * (1 - kPt);
}

}  // namespace

std::vector<float> flip_map(std::span<const glm::vec4> reference, std::span<const glm::vec4> test, int width,
                            int height, double pixels_per_degree) {
  const Size size{width, height};
  const Percept a = perceive(reference, size, pixels_per_degree), b = perceive(test, size, pixels_per_degree);
  // The largest difference there is lies between the green and the blue primary.
  const float largest = std::pow(hyab(to_hunt_lab({0, 1, 0}), to_hunt_lab({0, 0, 1})), kQc);
  std::vector<float> flip(size.count());
  for (std::size_t i = 0; i < flip.size(); ++i) {
    const float color = redistribute(std::pow(hyab(a.color[i], b.color[i]), kQc), largest);
    const float feature = std::max(std::abs(a.edge[i] - b.edge[i]), std::abs(a.point[i] - b.point[i]));
    const float feature_difference = std::pow(feature / std::numbers::sqrt2_v<float>, kQf);
    flip[i] = std::pow(color, 1 - feature_difference);
  }
  return flip;
}

}  // namespace catoptra::render
