#include "app/src/file_report.h"

#include <array>
#include <cstdio>
#include <iterator>

#include "cad_import/lens_faces.h"

namespace catoptra::app {
namespace {

using nlohmann::ordered_json;

template <typename Vector>
ordered_json triple(const Vector& v) {
  return {v[0], v[1], v[2]};
}

template <typename Color>
ordered_json color_json(const std::optional<Color>& color) {
  return color ? triple(*color) : ordered_json(nullptr);
}

ordered_json face_json(const cad_import::Face& face) {
  return {{"id", face.id},
          {"index", face.index},
          {"name", face.name},
          {"surface", face.surface ? surface_name(face.surface->kind()) : "none"},
          {"area_mm2", face.area_mm2},
          {"planar", face.planar},
          {"color", color_json(face.color)}};
}

/// Only where a body looks like a lens. Curvatures in 1/mm, larger first.
void add_lens_json(const cad_import::CadModel& model, std::size_t body, ordered_json& report) {
  const auto lens = cad_import::lens_in_body(model, static_cast<int>(body));
  if (!lens) return;
  const cad_import::LensGeometry& g = lens->geometry;
  report["lens"] = {{"front", lens->front},
                    {"back", lens->back},
                    {"rim", lens->rim},
                    {"axis", triple(g.axis)},
                    {"center_thickness_mm", g.center_thickness_mm},
                    {"front_vertex_mm", triple(g.front_vertex_mm)},
                    {"back_vertex_mm", triple(g.back_vertex_mm)},
                    {"front_vertex_curvature", {g.front_curvature.k1, g.front_curvature.k2}},
                    {"back_vertex_curvature", {g.back_curvature.k1, g.back_curvature.k2}}};
}

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

std::string box_text(const ordered_json& box) {
  if (box.is_null()) return "empty";
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis)
    text += format("%s%.6g", axis ? " x " : "", box["size"][axis].get<double>());
  for (const char* corner : {"min", "max"}) {
    text += corner == std::string_view("min") ? " mm, from (" : ") to (";
    for (std::size_t axis = 0; axis < 3; ++axis)
      text += format("%s%.6g", axis ? ", " : "", box[corner][axis].get<double>());
  }
  return text + ")";
}

std::string lens_text(const ordered_json& lens) {
  const auto value = [&](const char* key, std::size_t i) { return lens[key][i].get<double>(); };
  return format("    looks like a lens: axis (%.6g, %.6g, %.6g), %.6g mm thick at its center\n",
                value("axis", 0), value("axis", 1), value("axis", 2),
                lens["center_thickness_mm"].get<double>()) +
         format("      vertex curvatures: front %.6g and %.6g, back %.6g and %.6g per mm\n",
                value("front_vertex_curvature", 0), value("front_vertex_curvature", 1),
                value("back_vertex_curvature", 0), value("back_vertex_curvature", 1));
}

std::string body_text(const ordered_json& body) {
  const std::string name = body["name"].get<std::string>();
  std::string text = format("  body '%s' (%s, %zu faces)\n", name.c_str(),
                            body["solid"].get<bool>() ? "solid" : "not closed", body["faces"].size());
  for (const ordered_json& face : body["faces"])
    text += format("    %4d  %-18s  %-10s  %14.6g mm2%s  %s\n", face["index"].get<int>(),
                   face["id"].get<std::string>().c_str(), face["surface"].get<std::string>().c_str(),
                   face["area_mm2"].get<double>(), face["planar"].get<bool>() ? "  planar" : "        ",
                   face["name"].get<std::string>().c_str());
  if (body.contains("lens")) text += lens_text(body["lens"]);
  return text;
}

}  // namespace

std::string_view surface_name(cad_import::SurfaceKind kind) {
  // In the order of SurfaceKind.
  constexpr std::string_view kNames[] = {"plane",   "cylinder",   "cone",      "sphere", "torus", "bezier",
                                         "bspline", "revolution", "extrusion", "offset", "other"};
  static_assert(std::size(kNames) == std::size_t(cad_import::SurfaceKind::other) + 1);
  return kNames[static_cast<std::size_t>(kind)];
}

ordered_json box_json(const cad_import::BoundingBox& box) {
  if (box.empty()) return nullptr;
  return {{"min", triple(box.min)}, {"max", triple(box.max)}, {"size", triple(box.max - box.min)}};
}

ordered_json cad_json(const cad_import::CadModel& model) {
  ordered_json bodies = ordered_json::array();
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const auto& body = model.bodies[i];
    ordered_json faces = ordered_json::array();
    for (const int index : body.faces) faces.push_back(face_json(model.faces[std::size_t(index)]));
    bodies.push_back(
        {{"name", body.name}, {"color", color_json(body.color)}, {"solid", body.solid}, {"faces", faces}});
    add_lens_json(model, i, bodies.back());
  }
  return {{"file", model.file},
          {"format", model.format},
          {"unit", model.unit},
          {"bodies", bodies},
          {"bounding_box_mm", box_json(model.bounds)},
          {"warnings", model.warnings}};
}

ordered_json mesh_json(const cad_import::TriangleMesh& mesh) {
  ordered_json materials = ordered_json::array(), textures = ordered_json::array();
  for (const auto& material : mesh.materials) {
    const bool textured = material.texture >= 0;
    materials.push_back(
        {{"name", material.name},
         {"color", triple(material.base_color)},
         {"texture", textured ? ordered_json(mesh.textures[std::size_t(material.texture)].name) : nullptr}});
  }
  for (const auto& texture : mesh.textures) textures.push_back(texture.name);
  return {{"file", mesh.file},
          {"format", mesh.format},
          {"triangles", mesh.triangles.size()},
          {"vertices", mesh.positions.size()},
          {"materials", materials},
          {"textures", textures},
          {"bounding_box_mm", box_json(mesh.bounds)},
          {"warnings", mesh.warnings}};
}

std::string plain_text(const ordered_json& file) {
  std::string text = file["file"].get<std::string>() + "\n  format " + file["format"].get<std::string>();
  if (file.contains("unit")) text += ", unit " + file["unit"].get<std::string>();
  text += "\n  box " + box_text(file["bounding_box_mm"]) + "\n";
  if (file.contains("bodies"))
    for (const ordered_json& body : file["bodies"]) text += body_text(body);
  if (file.contains("triangles"))
    text += format("  %zu triangles, %zu vertices, %zu materials, %zu textures\n",
                   file["triangles"].get<std::size_t>(), file["vertices"].get<std::size_t>(),
                   file["materials"].size(), file["textures"].size());
  for (const ordered_json& warning : file["warnings"])
    text += "  warning: " + warning.get<std::string>() + "\n";
  return text;
}

}  // namespace catoptra::app
