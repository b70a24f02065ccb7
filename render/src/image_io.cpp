#include "render/image_io.h"

#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <system_error>

#include "cad_import/error.h"

namespace catoptra::render {
namespace {

/// The layers of an EXR with geometry, in the order of writing: colour, then one float per name.
const std::vector<std::string>& channel_names() {
  static const std::vector<std::string> names{"R",           "G",           "B",          "A",
                                              "position.X",  "position.Y",  "position.Z", "position.W",
                                              "surface.X",   "surface.Y",   "surface.Z",  "direction.X",
                                              "direction.Y", "direction.Z", "optic.ID"};
  return names;
}
constexpr int kColorChannels = 4;

[[noreturn]] void fail(const std::filesystem::path& file, std::string reason, const std::string& hint = {}) {
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  throw Error(file.string(), "", std::move(reason), hint);
}

std::string lower_suffix(const std::filesystem::path& file) {
  std::string s = file.extension().string();
  std::transform(s.begin(), s.end(), s.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return s;
}

bool complete_geometry(const Frame& frame) {
  const std::size_t n = frame.color.size();
  return frame.position.size() == n && frame.surface.size() == n && frame.direction.size() == n &&
         frame.optic_id.size() == n;
}

/// A name beside the target that no other process uses, with the suffix that decides the format.
std::filesystem::path temporary_beside(const std::filesystem::path& file) {
  std::filesystem::path temporary = file;
  temporary.replace_filename(file.stem().string() + ".part" + std::to_string(::getpid()) +
                             file.extension().string());
  return temporary;
}

OIIO::ImageSpec png_spec(const Frame& frame) {
  OIIO::ImageSpec spec(frame.width, frame.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  return spec;
}

std::vector<float> png_values(const Frame& frame) {
  std::vector<float> values;
  values.reserve(frame.color.size() * 3);
  for (const glm::vec4& c : frame.color)
    for (int k = 0; k < 3; ++k) values.push_back(linear_to_srgb(std::clamp(c[k], 0.0f, 1.0f)));
  return values;
}

OIIO::ImageSpec exr_spec(const Frame& frame, bool with_geometry) {
  const auto& names = channel_names();
  const int channels = with_geometry ? int(names.size()) : kColorChannels;
  OIIO::ImageSpec spec(frame.width, frame.height, channels, OIIO::TypeDesc::HALF);
  spec.channelnames.assign(names.begin(), names.begin() + channels);
  spec.alpha_channel = 3;
  if (with_geometry) {
    spec.channelformats.assign(names.size(), OIIO::TypeDesc::FLOAT);
    std::fill_n(spec.channelformats.begin(), kColorChannels, OIIO::TypeDesc(OIIO::TypeDesc::HALF));
    spec.format = OIIO::TypeDesc::FLOAT;
  }
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  return spec;
}

std::vector<float> exr_values(const Frame& frame, bool with_geometry) {
  std::vector<float> values;
  values.reserve(frame.color.size() * (with_geometry ? channel_names().size() : kColorChannels));
  for (std::size_t i = 0; i < frame.color.size(); ++i) {
    const glm::vec4& c = frame.color[i];
    values.insert(values.end(), {c.r, c.g, c.b, c.a});
    if (!with_geometry) continue;
    const glm::vec4& p = frame.position[i];
    const glm::vec3 &s = frame.surface[i], &d = frame.direction[i];
    values.insert(values.end(), {p.x, p.y, p.z, p.w, s.x, s.y, s.z, d.x, d.y, d.z, float(frame.optic_id[i])});
  }
  return values;
}

/// Writes to `temporary`; every failure of the library becomes an Error.
void write_with_oiio(const std::filesystem::path& file, const std::filesystem::path& temporary,
                     const OIIO::ImageSpec& spec, const std::vector<float>& values) {
  const auto output = OIIO::ImageOutput::create(temporary.string());
  if (!output) fail(file, "no writer for this kind of image: " + OIIO::geterror());
  if (!output->open(temporary.string(), spec)) fail(file, "cannot be written: " + output->geterror());
  if (!output->write_image(OIIO::TypeDesc::FLOAT, values.data()) || !output->close())
    fail(file, "cannot be written: " + output->geterror());
}

/// Index of channel `name`, or -1.
int channel_index(const OIIO::ImageSpec& spec, const std::string& name) {
  const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
  return found == spec.channelnames.end() ? -1 : int(found - spec.channelnames.begin());
}

void fill_geometry(Frame& frame, const OIIO::ImageSpec& spec, const std::vector<float>& values) {
  const auto& names = channel_names();
  std::array<int, 11> at{};
  for (std::size_t k = 0; k < at.size(); ++k) {
    at[k] = channel_index(spec, names[kColorChannels + k]);
    if (at[k] < 0) return;  // an EXR of another program, or colour only
  }
  const std::size_t count = frame.color.size();
  for (std::size_t i = 0; i < count; ++i) {
    const float* v = &values[i * std::size_t(spec.nchannels)];
    frame.position.emplace_back(v[at[0]], v[at[1]], v[at[2]], v[at[3]]);
    frame.surface.emplace_back(v[at[4]], v[at[5]], v[at[6]]);
    frame.direction.emplace_back(v[at[7]], v[at[8]], v[at[9]]);
    frame.optic_id.push_back(int(std::lround(v[at[10]])));
  }
}

}  // namespace

float linear_to_srgb(float linear) {
  if (!(linear > 0.0031308f)) return 12.92f * linear;
  return 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float srgb_to_linear(float srgb) {
  if (!(srgb > 0.04045f)) return srgb / 12.92f;
  return std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

void write_image(const Frame& frame, const std::filesystem::path& file, bool with_geometry) {
  if (frame.width < 1 || frame.height < 1 ||
      frame.color.size() != std::size_t(frame.width) * std::size_t(frame.height))
    fail(file, "there is no picture to write");
  const std::string suffix = lower_suffix(file);
  if (suffix != ".png" && suffix != ".exr") fail(file, "unknown suffix '" + suffix + "'", "use .png or .exr");
  if (with_geometry && suffix == ".exr" && !complete_geometry(frame))
    fail(file, "the frame has no geometry to write");
  const std::filesystem::path temporary = temporary_beside(file);
  try {
    if (suffix == ".png")
      write_with_oiio(file, temporary, png_spec(frame), png_values(frame));
    else
      write_with_oiio(file, temporary, exr_spec(frame, with_geometry), exr_values(frame, with_geometry));
    std::filesystem::rename(temporary, file);
  } catch (const std::filesystem::filesystem_error& e) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    fail(file, "cannot be written: " + e.code().message());
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

Frame read_image(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) fail(file, "image file not found");
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) fail(file, "cannot be read: " + OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  Frame frame;
  frame.width = spec.width;
  frame.height = spec.height;
  const std::size_t count = std::size_t(spec.width) * std::size_t(spec.height),
                    channels = std::size_t(spec.nchannels);
  std::vector<float> values(count * channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()))
    fail(file, "cannot be read: " + input->geterror());
  const bool encoded = !spec.format.is_floating_point();
  // EXR channels may come in any order: by name where they have one, else grey or RGB by position.
  std::array<int, 3> rgb{channel_index(spec, "R"), channel_index(spec, "G"), channel_index(spec, "B")};
  if (rgb[0] < 0 || rgb[1] < 0 || rgb[2] < 0)
    rgb = channels >= 3 ? std::array<int, 3>{0, 1, 2} : std::array<int, 3>{0, 0, 0};
  frame.color.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    glm::vec4 c(0, 0, 0, 1);
    for (int k = 0; k < 3; ++k) {
      const float v = values[i * channels + std::size_t(rgb[std::size_t(k)])];
      c[k] = encoded ? srgb_to_linear(v) : v;
    }
    frame.color.push_back(c);
  }
  fill_geometry(frame, spec, values);
  return frame;
}

}  // namespace catoptra::render
