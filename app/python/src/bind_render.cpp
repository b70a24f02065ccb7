// Scenes and their pictures as NumPy arrays.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <glm/trigonometric.hpp>
#include <memory>
#include <mutex>

#include "app/python/src/arrays.h"
#include "app/python/src/bindings.h"
#include "app/python/src/scene_handle.h"
#include "render/image_io.h"

namespace catoptra::python {
namespace {

/// A picture, top row first.
struct Picture {
  render::RenderResult result;
};

/// Some float fields of each pixel as an array of shape (height, width, channels), copied.
template <typename Pixel>
py::object layer(const render::Frame& frame, const std::vector<Pixel>& pixels, int channels) {
  if (pixels.empty()) return py::none();
  py::array_t<float> array({py::ssize_t(frame.height), py::ssize_t(frame.width), py::ssize_t(channels)});
  float* to = array.mutable_data();
  for (const Pixel& pixel : pixels)
    for (int k = 0; k < channels; ++k) *to++ = pixel[k];
  return array;
}

py::array_t<std::uint8_t> srgb(const render::Frame& frame) {
  py::array_t<std::uint8_t> array({py::ssize_t(frame.height), py::ssize_t(frame.width), py::ssize_t(3)});
  std::uint8_t* to = array.mutable_data();
  for (const glm::vec4& pixel : frame.color)
    for (int k = 0; k < 3; ++k) {
      const float value = render::linear_to_srgb(std::min(std::max(pixel[k], 0.0f), 1.0f));
      *to++ = std::uint8_t(std::lround(255 * value));
    }
  return array;
}

py::object optic_ids(const render::Frame& frame) {
  if (frame.optic_id.empty()) return py::none();
  py::array_t<std::int32_t> array({py::ssize_t(frame.height), py::ssize_t(frame.width)});
  std::copy(frame.optic_id.begin(), frame.optic_id.end(), array.mutable_data());
  return array;
}

Picture draw(SceneHandle& scene, const std::string& mode_name, std::optional<std::pair<int, int>> resolution,
             int samples, bool geometry, std::size_t threads) {
  const auto mode = render::mode_from_name(mode_name);
  if (!mode) throw py::value_error("unknown mode '" + mode_name + "'");
  const py::gil_scoped_release release;
  const std::lock_guard lock(scene.mutex);  // a renderer draws one picture at a time
  render::FrameOptions options;
  options.width = resolution ? resolution->first : scene.camera.resolution.x;
  options.height = resolution ? resolution->second : scene.camera.resolution.y;
  options.samples = samples;
  options.geometry = geometry;
  options.threads = threads;
  if (!scene.renderer) scene.renderer = std::make_unique<render::Renderer>(scene.file.scene);
  return {scene.renderer->render(*mode, scene.camera, options)};
}

glm::dvec3 vector_of(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

void bind_picture(py::module_& module) {
  py::class_<Picture>(
      module, "Picture",
      "A rendered picture, top row first. Geometry layers are None unless they were asked for.")
      .def_property_readonly(
          "color", [](const Picture& p) { return layer(p.result.frame, p.result.frame.color, 3); },
          "Linear RGB, float32, shape (height, width, 3).")
      .def_property_readonly(
          "srgb", [](const Picture& p) { return srgb(p.result.frame); },
          "sRGB, uint8, shape (height, width, 3).")
      .def_property_readonly(
          "position", [](const Picture& p) { return layer(p.result.frame, p.result.frame.position, 4); },
          "World point shown, mm, with w = 1; a direction with w = 0 for the sky.")
      .def_property_readonly(
          "surface", [](const Picture& p) { return layer(p.result.frame, p.result.frame.surface, 3); },
          "Last point on the optic, mm.")
      .def_property_readonly(
          "direction", [](const Picture& p) { return layer(p.result.frame, p.result.frame.direction, 3); },
          "Unit direction in which the ray leaves the optic.")
      .def_property_readonly(
          "optic_id", [](const Picture& p) { return optic_ids(p.result.frame); },
          "Index of the optic shown, -1 where there is none; int32, shape (height, width).")
      .def_property_readonly("time_ms", [](const Picture& p) { return p.result.stats.time_ms; })
      .def_property_readonly("rays", [](const Picture& p) { return p.result.stats.rays; })
      .def_property_readonly("warnings", [](const Picture& p) { return p.result.warnings; });
}

}  // namespace

void bind_render(py::module_& module) {
  bind_picture(module);
  py::class_<SceneHandle, std::shared_ptr<SceneHandle>>(module, "Scene",
                                                        "A scene file, read with all that it names.")
      .def(py::init([](const std::filesystem::path& file) {
             const py::gil_scoped_release release;
             return SceneHandle::read(file);
           }),
           py::arg("file"))
      .def_property_readonly("mirrors",
                             [](const SceneHandle& s) { return s.names(optics::OpticKind::mirror); })
      .def_property_readonly("lenses", [](const SceneHandle& s) { return s.names(optics::OpticKind::lens); })
      .def_property_readonly("warnings", [](const SceneHandle& s) { return s.file.scene.warnings; })
      .def(
          "look",
          [](SceneHandle& s, const std::optional<std::array<double, 3>>& eye,
             const std::optional<std::array<double, 3>>& target,
             const std::optional<std::array<double, 3>>& up, const std::optional<double>& fov_deg) {
            const py::gil_scoped_release release;  // a picture may be in the making
            const std::lock_guard lock(s.mutex);
            if (eye) s.camera.eye_mm = vector_of(*eye);
            if (target) s.camera.target_mm = vector_of(*target);
            if (up) s.camera.up = vector_of(*up);
            if (fov_deg) s.camera.fov_rad = glm::radians(*fov_deg);
          },
          py::kw_only(), py::arg("eye_mm") = py::none(), py::arg("target_mm") = py::none(),
          py::arg("up") = py::none(), py::arg("fov_deg") = py::none(),
          "Moves the camera for the pictures that follow; what is left out stays.")
      .def("render", &draw, py::kw_only(), py::arg("mode") = "pvrr", py::arg("resolution") = py::none(),
           py::arg("samples") = 1, py::arg("geometry") = false, py::arg("threads") = 0,
           "Draws a picture; resolution is (width, height). Other threads of Python run meanwhile.");
}

}  // namespace catoptra::python
