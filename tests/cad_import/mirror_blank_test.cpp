// Mirror glasses written as STEP: judged by the ideal surfaces' closed forms and by the kernel's own reader.
#include "cad_import/mirror_blank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>
#include <string>

#include "cad_import/import.h"
#include "tests/cad_import/mesh_files.h"

namespace catoptra::cad_import {
namespace {

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

int occurrences(const std::string& text, const std::string& word) {
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(MirrorSag, SphereAgreesWithCircle) {
  MirrorBlank blank;
  blank.radius_h_mm = blank.radius_v_mm = 1200;
  EXPECT_NEAR(mirror_sag_mm(blank, 60, 30), std::sqrt(1200. * 1200 - 60 * 60 - 30 * 30) - 1200, 1e-10);
  blank.radius_h_mm = blank.radius_v_mm = -300;  // concave: the rim stands above the pole
  EXPECT_NEAR(mirror_sag_mm(blank, -60, 30), 300 - std::sqrt(300. * 300 - 60 * 60 - 30 * 30), 1e-10);
  blank.radius_h_mm = blank.radius_v_mm = 0;
  EXPECT_EQ(mirror_sag_mm(blank, 60, 30), 0);
}

TEST(MirrorSag, AsphericStripHasItsRadiusAtTheEdge) {
  MirrorBlank blank;
  blank.aspheric = AsphericPart{40, 300, false};
  const auto z = [&](double x) { return mirror_sag_mm(blank, x, 0); };
  // Curvature of the section by central differences; step 0.05 mm gives about 1e-7 relative.
  const auto radius = [&](double x) {
    const double h = 0.05;
    const double slope = (z(x + h) - z(x - h)) / (2 * h);
    const double bend = (z(x + h) - 2 * z(x) + z(x - h)) / (h * h);
    return -std::pow(1 + slope * slope, 1.5) / bend;
  };
  EXPECT_NEAR(radius(20), 1200, 0.01);
  EXPECT_NEAR(radius(39.9), 1200, 0.01);
  // Half-way along the strip, x = 62.5, the curvature is the mean of both ends.
  EXPECT_NEAR(radius(62.5), 2 / (1 / 1200. + 1 / 300.), 0.01);
  EXPECT_NEAR(radius(84.9), 1 / (1 / 1200. + (1 / 300. - 1 / 1200.) * 44.9 / 45), 0.01);
  blank.aspheric->towards_minus_x = true;
  EXPECT_NEAR(radius(-62.5), 2 / (1 / 1200. + 1 / 300.), 0.01);
  EXPECT_NEAR(radius(62.5), 1200, 0.01);
}

TEST(MirrorBlankFile, NamesItsFacesAndLeavesNoOtherFile) {
  const ScratchFolder folder;
  write_mirror_blank({}, folder / "door.step");
  const std::string text = contents(folder / "door.step");
  EXPECT_EQ(occurrences(text, "ADVANCED_FACE('Glass'"), 1);
  EXPECT_EQ(occurrences(text, "ADVANCED_FACE('Back'"), 1);
  EXPECT_EQ(occurrences(text, "ADVANCED_FACE('Edge'"), 4);
  EXPECT_NE(text.find("SI_UNIT(.MILLI.,.METRE.)"), std::string::npos);
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1);
}

/// Largest distance in z of the imported `Glass` from the ideal surface over 40 x 40 points inside the
/// outline.
double glass_error_mm(const MirrorBlank& blank, const std::filesystem::path& file) {
  write_mirror_blank(blank, file);
  const CadModel model = import_cad(file);
  EXPECT_EQ(model.bodies.size(), 1u);
  EXPECT_TRUE(model.bodies.front().solid);
  double worst = 0;
  for (const Face& face : model.faces) {
    if (face.name != "Glass") continue;
    EXPECT_EQ(face.surface->kind(), SurfaceKind::bspline);
    EXPECT_GT(face.surface->unit_normal(0, 0).z, 0.999);  // u = x, v = y: the pole, seen from outside
    EXPECT_NEAR(glm::length(face.surface->point(0, 0)), 0, 1e-6);
    const ParameterDomain d = face.surface->domain();
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; j <= 40; ++j) {
        const double u = d.u_min + (d.u_max - d.u_min) * i / 40, v = d.v_min + (d.v_max - d.v_min) * j / 40;
        if (!face.trim->contains(u, v)) continue;
        const glm::dvec3 p = face.surface->point(u, v);
        worst = std::max(worst, std::abs(p.z - mirror_sag_mm(blank, p.x, p.y)));
      }
    return worst;
  }
  ADD_FAILURE() << "no face is called Glass";
  return 0;
}

TEST(MirrorBlankFile, GlassReadsBackWithinAMillionthOfAMillimetre) {
  const ScratchFolder folder;
  constexpr double kPromise_mm = 1e-6;  // write_mirror_blank's
  MirrorBlank blank;
  EXPECT_LT(glass_error_mm(blank, folder / "door.step"), kPromise_mm);
  blank.outline = MirrorOutline::rounded;
  blank.radius_h_mm = blank.radius_v_mm = -400;
  EXPECT_LT(glass_error_mm(blank, folder / "concave.step"), kPromise_mm);
  blank.radius_h_mm = 900;
  blank.radius_v_mm = 0;
  EXPECT_LT(glass_error_mm(blank, folder / "cylinder.step"), kPromise_mm);
  blank.radius_h_mm = blank.radius_v_mm = 1200;
  blank.aspheric = AsphericPart{40, 200, true};
  EXPECT_LT(glass_error_mm(blank, folder / "aspheric.step"), kPromise_mm);
}

TEST(MirrorBlankFile, EveryKindOfGlassAndOutlineIsAValidSolid) {
  const ScratchFolder folder;
  MirrorBlank blank;
  for (const auto& [h, v] : {std::pair{1200., 1200.}, {0., 0.}, {-300., -300.}, {800., 0.}, {-900., 1500.}}) {
    blank.radius_h_mm = h;
    blank.radius_v_mm = v;
    blank.outline = MirrorOutline::rectangle;
    EXPECT_NO_THROW(write_mirror_blank(blank, folder / "rectangle.step")) << h << " " << v;
    blank.outline = MirrorOutline::rounded;
    EXPECT_NO_THROW(write_mirror_blank(blank, folder / "rounded.step")) << h << " " << v;
    blank.outline = MirrorOutline::polygon;
    blank.polygon = {{-80, -40}, {-60, 50}, {70, 55}, {85, 0}, {60, -50}};  // clockwise, and concave nowhere
    EXPECT_NO_THROW(write_mirror_blank(blank, folder / "polygon.step")) << h << " " << v;
  }
  blank = {};
  blank.aspheric = AsphericPart{};
  EXPECT_NO_THROW(write_mirror_blank(blank, folder / "aspheric.step"));
  blank = {};
  blank.radius_h_mm = blank.radius_v_mm = -150;  // a round make-up mirror
  blank.width_mm = blank.height_mm = 120;
  blank.outline = MirrorOutline::rounded;
  blank.corner_radius_mm = 60;
  EXPECT_NO_THROW(write_mirror_blank(blank, folder / "round.step"));
}

std::string message_of(const MirrorBlank& blank) {
  const ScratchFolder folder;
  try {
    write_mirror_blank(blank, folder / "bad.step");
  } catch (const Error& error) {
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    return error.what();
  }
  return "no error";
}

TEST(MirrorBlankFile, RefusesWhatCannotBeMade) {
  MirrorBlank blank;
  blank.radius_h_mm = blank.radius_v_mm = 100;
  EXPECT_EQ(message_of(blank),
            "mirror: radius: 100 mm is too small for a glass that reaches 101.242284 mm from its pole (make "
            "the glass "
            "smaller or the radius larger)");
  blank = {};
  blank.width_mm = -1;
  EXPECT_EQ(message_of(blank), "mirror: width: must be more than 0 mm");
  blank = {};
  blank.thickness_mm = 0;
  EXPECT_EQ(message_of(blank), "mirror: thickness: must be more than 0 mm");
  blank = {};
  blank.radius_h_mm = std::nan("");
  EXPECT_EQ(message_of(blank), "mirror: radius: must be finite");
  blank = {};
  blank.outline = MirrorOutline::rounded;
  blank.corner_radius_mm = 56;
  EXPECT_EQ(message_of(blank),
            "mirror: corner radius: 56 mm is not between 0 and half of the smaller side, 55 mm");
  blank = {};
  blank.outline = MirrorOutline::polygon;
  blank.polygon = {{0, 0}, {10, 10}, {10, 0}, {0, 10}};
  EXPECT_EQ(message_of(blank), "mirror: outline corner 1: the outline crosses itself at side 3");
  blank = {};
  blank.aspheric = AsphericPart{90, 300, false};
  EXPECT_EQ(message_of(blank),
            "mirror: aspheric boundary: 90 mm is not between the pole and the edge at 85 mm");
}

TEST(MirrorBlankFile, UnwritableFolderIsAnError) {
  EXPECT_THROW(write_mirror_blank({}, "/nonexistent-folder/door.step"), Error);
}

TEST(MirrorOutlineFile, ReadsCornersAndNamesTheBadLine) {
  const ScratchFolder folder;
  std::ofstream(folder / "good.txt") << "# house shape\n0 0\n40, 0\n\n40 30 # corner\n20 45\n0 30\n0 0\n";
  const auto corners = read_outline(folder / "good.txt");
  ASSERT_EQ(corners.size(), 5u);
  EXPECT_EQ(corners[3], glm::dvec2(20, 45));
  std::ofstream(folder / "bad.txt") << "0 0\n1 zero\n";
  try {
    (void)read_outline(folder / "bad.txt");
    FAIL();
  } catch (const ImportError& error) {
    EXPECT_EQ(error.entity(), "line 2");
  }
  EXPECT_THROW((void)read_outline(folder / "absent.txt"), ImportError);
}

}  // namespace
}  // namespace catoptra::cad_import
