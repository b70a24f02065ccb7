// Writes the models of the examples as .glb files into a folder: the street, the car around the driver, a
// wall, a living room, mounts of lenses, the stages of the paper's plates.
#include <filesystem>
#include <fstream>
#include <iostream>

#include "examples/plates/stage.h"
#include "examples/room/dressing_table.h"
#include "examples/room/room.h"
#include "examples/room/room_palette.h"
#include "examples/room/spectacles.h"
#include "examples/street/car.h"
#include "examples/street/cockpit.h"
#include "examples/street/flank.h"
#include "examples/street/glb.h"
#include "examples/street/house.h"
#include "examples/street/interiors.h"
#include "examples/street/palette.h"
#include "examples/street/street.h"

namespace {

using namespace catoptra::examples;

/// The glasses of the scenes that have a shell behind them.
struct Housing {
  const char* name;
  float width_m, height_m, radius_m;
};
constexpr Housing kHousings[] = {
    {"convex_300", 0.170f, 0.110f, 0.3f},    {"convex_600", 0.170f, 0.110f, 0.6f},
    {"convex_1200", 0.170f, 0.110f, 1.2f},   {"convex_3000", 0.170f, 0.110f, 3.0f},
    {"plane", 0.170f, 0.110f, 0.0f},         {"concave_3000", 0.170f, 0.110f, -3.0f},
    {"concave_1200", 0.170f, 0.110f, -1.2f}, {"interior", 0.240f, 0.062f, 0.0f},
    {"makeup", 0.170f, 0.120f, -0.8f},       {"dressing", 0.170f, 0.130f, -0.6f}};

void write(const std::filesystem::path& file, const Model& model, const Palette& palette) {
  const auto bytes = write_glb(model, palette, file.stem().string());
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
  std::cout << file.filename().string() << ": " << model.triangle_count() << " triangles, " << bytes.size()
            << " bytes\n";
}

/// The stages of the 1994 paper's plates.
void write_stages(const std::filesystem::path& folder, const Palette& palette) {
  write(folder / "plate1.glb", make_refraction_stage(), palette);
  write(folder / "plate2.glb", make_mirror_room(), palette);
  write(folder / "figure2.glb", make_light_stage(refraction_stage()), palette);
  write(folder / "figure2_mirror.glb", make_light_stage(reflection_stage()), palette);
  write(folder / "plate3.glb", make_caustic_stage(refraction_stage()), palette);
  write(folder / "plate4.glb", make_translucency_stage(), palette);
  write(folder / "plate5.glb", make_combined_stage(), palette);
}

/// What the street scenes with planar optics add to the street.
void write_windows(const std::filesystem::path& folder, const Palette& palette) {
  write(folder / "shop_row.glb", make_shop_row(), palette);
  write(folder / "window_front.glb", make_window_front(), palette);
  write(folder / "cockpit.glb", make_cockpit(), palette);
  write(folder / "parked_car.glb", make_car({CarShape::hatchback, "car red", 5}), palette);
  write(folder / "mirror_stand.glb", make_mirror_stand(), palette);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::cerr << "usage: make_models FONT.ttf FOLDER\n";
    return 2;
  }
  Palette palette = make_palette(argv[1]);
  add_room_paints(palette, argv[1]);
  add_stage_paints(palette, argv[1]);
  const std::filesystem::path folder = argv[2];
  std::filesystem::create_directories(folder);
  write(folder / "street.glb", make_street(), palette);
  write(folder / "flank.glb", make_flank(), palette);
  write(folder / "cabin.glb", make_cabin(), palette);
  for (const Housing& housing : kHousings)
    write(folder / (std::string("housing_") + housing.name + ".glb"),
          make_housing(housing.width_m, housing.height_m, housing.radius_m), palette);
  write(folder / "wall.glb", make_wall(), palette);
  write(folder / "room.glb", make_room(), palette);
  write(folder / "dressing_table.glb", make_dressing_table(), palette);
  write(folder / "spectacle_frame.glb", make_spectacle_frame({}), palette);
  write(folder / "hand_lens.glb", make_hand_lens(0.065f), palette);
  write_stages(folder, palette);
  write_windows(folder, palette);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "make_models: " << error.what() << '\n';
  return 1;
}
