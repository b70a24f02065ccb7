// A small scene on disk: a mirror from CAD and a coloured wall that it shows.
#pragma once

#include <filesystem>
#include <string>

#include "cad_import/mirror_blank.h"
#include "tests/support/temporary_folder.h"

namespace catoptra::test {

/// An 80 x 60 mm mirror glass as `mirror.step`; radius as MirrorBlank has it.
inline std::filesystem::path write_test_mirror(const TemporaryFolder& folder, double radius_mm,
                                               const std::string& name = "mirror.step") {
  cad_import::MirrorBlank blank;
  blank.radius_h_mm = blank.radius_v_mm = radius_mm;
  blank.width_mm = 80;
  blank.height_mm = 60;
  cad_import::write_mirror_blank(blank, folder / name);
  return folder / name;
}

/// A wall of 6 x 6 m in the plane z = 1000 mm, red where x < 0 and green where x > 0, as `wall.obj` in mm.
inline void write_test_wall(const TemporaryFolder& folder) {
  folder.write("wall.mtl", "newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n");
  folder.write("wall.obj",
               "mtllib wall.mtl\n"
               "v -3000 -3000 1000\nv 0 -3000 1000\nv 3000 -3000 1000\nv -3000 3000 1000\nv 0 3000 1000\nv "
               "3000 3000 1000\n"
               "usemtl red\nf 1 4 5\nf 1 5 2\n"
               "usemtl green\nf 2 5 6\nf 2 6 3\n");
}

/// Mirror at the origin looking to +z, the eye 300 mm before it, the wall behind the eye.
inline std::filesystem::path write_test_scene(const TemporaryFolder& folder, double radius_mm = 400,
                                              const std::string& more = "") {
  write_test_mirror(folder, radius_mm);
  write_test_wall(folder);
  return folder.write(
      "scene.toml",
      "[camera]\neye = [0, 0, 300]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov_deg = 16\n"
      "resolution = [96, 64]\n"
      "[environment]\ncolor = [0, 0, 1]\nambient = 0.8\n"
      "[[surrounding]]\nfile = \"wall.obj\"\n"
      "[[mirror]]\nname = \"test mirror\"\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\ngrid = [9, 9]\n" +
          more);
}

}  // namespace catoptra::test
