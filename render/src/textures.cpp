#include "render/src/textures.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>

#include "cad_import/error.h"
#include "render/image_io.h"

namespace catoptra::render {
namespace {

constexpr int kMaxTextureSide = 16384;  // texels; what every OpenGL 4.5 implementation accepts

/// A decoded picture, linear RGBA, row-major, top row first.
struct FloatImage {
  int width = 1, height = 1;
  std::vector<glm::vec4> pixels{glm::vec4(1)};
};

/// The format of an embedded picture by its first bytes: the names inside containers often lack a suffix.
std::string_view sniff_image_format(const std::vector<std::byte>& bytes) {
  const auto starts = [&](std::string_view magic, std::size_t at = 0) {
    return bytes.size() >= at + magic.size() &&
           std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
  };
  if (starts("\x89PNG")) return "png";
  if (starts("\xff\xd8\xff")) return "jpeg";
  if (starts("\x76\x2f\x31\x01")) return "openexr";
  if (starts("#?RADIANCE")) return "hdr";
  if (starts("WEBP", 8)) return "webp";
  if (starts("DDS ")) return "dds";
  if (starts("BM")) return "bmp";
  if (starts("GIF8")) return "gif";
  return {};
}

std::string last_oiio_error(const OIIO::ImageInput* input) {
  std::string text = input ? input->geterror() : OIIO::geterror();
  if (text.empty()) text = "unknown error";
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Channel values as stored, in 0..1 for integer formats.
glm::vec4 expand_channels(const float* value, int channels) {
  switch (channels) {
    case 1:
      return {value[0], value[0], value[0], 1};
    case 2:
      return {value[0], value[0], value[0], value[1]};
    case 3:
      return {value[0], value[1], value[2], 1};
    default:
      return {value[0], value[1], value[2], value[3]};
  }
}

/// Reads the whole picture and takes the transfer curve off: sRGB for integer formats, none for floating
/// point ones.
FloatImage read_linear(OIIO::ImageInput& input, const std::string& name, const std::string& file) {
  const OIIO::ImageSpec spec = input.spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kMaxTextureSide || spec.height > kMaxTextureSide)
    throw Error(
        file, name,
        "the image has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels",
        "at most " + std::to_string(kMaxTextureSide) + " a side");
  const int channels = spec.nchannels;
  const std::size_t count = std::size_t(spec.width) * std::size_t(spec.height);
  std::vector<float> values(count * std::size_t(channels));
  if (!input.read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, values.data()))
    throw Error(file, name, "cannot decode the image: " + last_oiio_error(&input));
  FloatImage image{spec.width, spec.height, std::vector<glm::vec4>(count)};
  const bool encoded = !spec.format.is_floating_point();
  for (std::size_t i = 0; i < count; ++i) {
    glm::vec4 c = expand_channels(&values[i * std::size_t(channels)], channels);
    if (encoded)
      for (int k = 0; k < 3; ++k) c[k] = srgb_to_linear(c[k]);
    image.pixels[i] = c;
  }
  return image;
}

/// Asks for alpha as stored, not multiplied into the colour.
OIIO::ImageSpec reader_hints() {
  OIIO::ImageSpec hints;
  hints["oiio:UnassociatedAlpha"] = 1;
  return hints;
}

FloatImage decode_file(const std::string& path, const std::string& name, const std::string& file) {
  if (!std::filesystem::is_regular_file(path))
    throw Error(file, name, "image file not found: " + path,
                "paths are relative to the file that names them");
  const OIIO::ImageSpec hints = reader_hints();
  const auto input = OIIO::ImageInput::open(path, &hints);
  if (!input) throw Error(file, name, "cannot decode the image: " + last_oiio_error(nullptr));
  return read_linear(*input, name, file);
}

FloatImage decode_memory(const std::vector<std::byte>& bytes, const std::string& name,
                         const std::string& file) {
  std::string format(sniff_image_format(bytes));
  if (format.empty()) format = std::filesystem::path(name).extension().string();
  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  const OIIO::ImageSpec hints = reader_hints();
  const auto input = format.empty() ? nullptr : OIIO::ImageInput::create(format, false, &hints, &reader);
  OIIO::ImageSpec spec;
  if (!input || !input->supports("ioproxy"))
    throw Error(file, name, "the embedded image has an unknown format", "PNG and JPEG are understood");
  // OpenImageIO 2.4 hands the proxy of create() on only where create() opens the file itself.
  input->set_ioproxy(&reader);
  if (!input->open(name.empty() ? "embedded" : name, spec, hints))
    throw Error(file, name, "cannot decode the image: " + last_oiio_error(input.get()));
  return read_linear(*input, name, file);
}

/// Halves a picture by box filter. Colours are weighted by alpha, so that what lies under transparent texels
/// (often black) does not bleed into the edges of foliage. For odd sizes a texel's box is wider than two
/// texels.
FloatImage half_size(const FloatImage& from) {
  FloatImage to;
  to.width = std::max(1, from.width / 2);
  to.height = std::max(1, from.height / 2);
  to.pixels.assign(std::size_t(to.width) * std::size_t(to.height), glm::vec4(0));
  const double sx = double(from.width) / to.width, sy = double(from.height) / to.height;
  const auto overlap = [](double begin, double end, int texel) {
    return std::min(end, texel + 1.0) - std::max(begin, double(texel));
  };
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x) {
      const double x0 = x * sx, x1 = x0 + sx, y0 = y * sy, y1 = y0 + sy;
      glm::dvec3 plain(0), weighted(0);
      double area = 0, alpha = 0;
      for (int j = int(y0); j < from.height && j < y1; ++j)
        for (int i = int(x0); i < from.width && i < x1; ++i) {
          const double w = overlap(x0, x1, i) * overlap(y0, y1, j);
          if (w <= 0) continue;
          const glm::dvec4 c(from.pixels[std::size_t(j) * std::size_t(from.width) + std::size_t(i)]);
          area += w;
          alpha += w * c.a;
          plain += w * glm::dvec3(c);
          weighted += w * c.a * glm::dvec3(c);
        }
      const glm::dvec3 color = alpha > 1e-6 * area ? weighted / alpha : plain / area;
      to.pixels[std::size_t(y) * std::size_t(to.width) + std::size_t(x)] = glm::vec4(color, alpha / area);
    }
  return to;
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

MipLevel encode(const FloatImage& image) {
  MipLevel level{image.width, image.height, {}};
  level.rgba.reserve(image.pixels.size() * 4);
  for (const glm::vec4& c : image.pixels) {
    for (int k = 0; k < 3; ++k) level.rgba.push_back(to_byte(linear_to_srgb(c[k])));
    level.rgba.push_back(to_byte(c.a));
  }
  return level;
}

MipTexture make_mips(FloatImage image) {
  MipTexture texture;
  texture.levels.push_back(encode(image));
  while (image.width > 1 || image.height > 1) {
    image = half_size(image);
    texture.levels.push_back(encode(image));
  }
  return texture;
}

/// A missing picture of a mesh is not an error where the import has said so already: it is drawn white.
bool import_warned(const cad_import::TriangleMesh& mesh, const cad_import::Texture& texture) {
  if (texture.path.empty() && texture.encoded.empty()) return true;
  if (!texture.encoded.empty() || texture.name.empty()) return false;
  return std::any_of(mesh.warnings.begin(), mesh.warnings.end(),
                     [&](const std::string& w) { return w.find(texture.name) != std::string::npos; });
}

FloatImage decode(const cad_import::TriangleMesh& mesh, const cad_import::Texture& texture) {
  if (!texture.encoded.empty()) return decode_memory(texture.encoded, texture.name, mesh.file);
  const bool there = !texture.path.empty() && std::filesystem::is_regular_file(texture.path);
  if (!there && import_warned(mesh, texture)) return {};
  return decode_file(texture.path, texture.name, mesh.file);
}

SkyImage load_sky(const Scene& scene) {
  SkyImage sky;
  if (scene.environment.sky.empty()) return sky;
  const FloatImage image = decode_file(scene.environment.sky, "environment.sky", scene.file);
  sky.width = image.width;
  sky.height = image.height;
  sky.rgb.reserve(image.pixels.size() * 3);
  for (const glm::vec4& c : image.pixels)
    for (int k = 0; k < 3; ++k) sky.rgb.push_back(std::isfinite(c[k]) ? c[k] : 0.0f);
  return sky;
}

}  // namespace

SceneTextures load_textures(const Scene& scene) {
  SceneTextures result;
  result.sky = load_sky(scene);
  result.textures.reserve(scene.surroundings.size());
  for (const cad_import::TriangleMesh& mesh : scene.surroundings) {
    auto& decoded = result.textures.emplace_back();
    decoded.reserve(mesh.textures.size());
    for (const cad_import::Texture& texture : mesh.textures)
      decoded.push_back(make_mips(decode(mesh, texture)));
  }
  return result;
}

}  // namespace catoptra::render
