// Small sRGB pictures, painted by program: the textures of the examples.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <string_view>
#include <vector>

namespace catoptra::examples {

/// sRGB and unassociated alpha, 0..255.
using Rgba = std::array<std::uint8_t, 4>;

/// `a` to `b` for t = 0..1, channel by channel in sRGB.
[[nodiscard]] Rgba mix(const Rgba& a, const Rgba& b, float t);

/// The same number in [0, 1) for the same arguments on every machine.
[[nodiscard]] float noise(int x, int y, int seed);

/// An outline font, rendered with grey levels.
class Font {
 public:
  /// Throws std::runtime_error where `file` is not a font.
  explicit Font(const std::filesystem::path& file);
  ~Font();
  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;

  struct Impl;
  [[nodiscard]] Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Rows from the top, pixels from the left. Everything that lies outside is clipped.
class Pixmap {
 public:
  Pixmap(int width, int height, const Rgba& color);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] Rgba at(int x, int y) const;
  void set(int x, int y, const Rgba& color);

  /// Covers [x0, x1) x [y0, y1).
  void rectangle(int x0, int y0, int x1, int y1, const Rgba& color);
  void disc(glm::vec2 centre, float radius, const Rgba& color);
  /// A convex polygon, corners in either order; edges are smoothed by 4 x 4 samples.
  void polygon(const std::vector<glm::vec2>& corners, const Rgba& color);
  /// One line of UTF-8 text, `height` px from baseline to the top of a capital, centred on `centre`, and made
  /// narrower where it would be wider than `max_width` px.
  void text(const Font& font, std::string_view utf8, glm::vec2 centre, float height, float max_width,
            const Rgba& color);
  /// Multiplies every colour by 1 - amount..1 + amount, by a noise with cells of `cell` px that repeats
  /// seamlessly.
  void grain(float amount, int cell, int seed);

  /// The PNG file's bytes: the same ones for the same pixels. Throws std::runtime_error.
  [[nodiscard]] std::vector<std::byte> png() const;

 private:
  void blend(int x, int y, const Rgba& color, float coverage);

  int width_, height_;
  std::vector<Rgba> pixels_;
};

}  // namespace catoptra::examples
