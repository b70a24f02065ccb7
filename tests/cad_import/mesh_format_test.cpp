// File formats from content and suffix; length units.
#include <gtest/gtest.h>

#include "cad_import/import.h"
#include "tests/cad_import/mesh_files.h"

namespace catoptra::cad_import {
namespace {

TEST(SniffFormat, ContentComesBeforeTheSuffix) {
  const ScratchFolder folder;
  const auto sniff = [&](const std::string& name, const std::string& content) {
    return sniff_format(folder.write(name, content));
  };
  EXPECT_EQ(sniff("a.igs", "ISO-10303-21;\nHEADER;\n"), FileFormat::step);
  EXPECT_EQ(sniff("b.step", std::string(72, ' ') + "S      1\n"), FileFormat::iges);
  EXPECT_EQ(sniff("c.dat", "DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\n"),
            FileFormat::brep);
  EXPECT_EQ(sniff("d.bin", std::string("glTF\x02\0\0\0", 8)), FileFormat::gltf);
  EXPECT_EQ(sniff("e.json", " {\"asset\": {\"version\": \"2.0\"}}"), FileFormat::gltf);
  EXPECT_EQ(sniff("f.obj", "ply\nformat ascii 1.0\n"), FileFormat::ply);
  EXPECT_EQ(sniff("g.txt", "solid thing\n facet normal 0 0 1\n"), FileFormat::stl);
  EXPECT_EQ(sniff("h.txt", "# cube\no cube\nv 0 0 0\nvn 0 0 1\n"), FileFormat::obj);
  std::string binary(84 + 50, '\0');
  binary[80] = 1;
  EXPECT_EQ(sniff("solid.dat", "solid" + binary.substr(5)), FileFormat::stl);
  EXPECT_EQ(sniff("i.json", "{\"name\": 1}"), FileFormat::unknown);
  EXPECT_EQ(sniff("j.txt", "v for vendetta\nis a film\n"), FileFormat::unknown);
}

TEST(SniffFormat, SuffixWhereTheContentSaysNothing) {
  const ScratchFolder folder;
  EXPECT_EQ(sniff_format(folder.write("a.STP", "?")), FileFormat::step);
  EXPECT_EQ(sniff_format(folder.write("a.Igs", "?")), FileFormat::iges);
  EXPECT_EQ(sniff_format(folder.write("a.brp", "?")), FileFormat::brep);
  EXPECT_EQ(sniff_format(folder.write("a.obj", "?")), FileFormat::obj);
  EXPECT_EQ(sniff_format(folder.write("a", "?")), FileFormat::unknown);
}

TEST(SniffFormat, FreeCadDocumentsAreToldByTheirContents) {
  const ScratchFolder folder;
  const auto file =
      folder.write("body.zip", std::string("PK\x03\x04", 4) + std::string(26, '\0') + "Document.xml<?xml");
  EXPECT_EQ(sniff_format(file), FileFormat::freecad);
  EXPECT_EQ(sniff_format(folder.write("a.fcstd", "?")), FileFormat::freecad);
  EXPECT_EQ(sniff_format(folder.write("other.zip", std::string("PK\x03\x04", 4))), FileFormat::unknown);
}

TEST(UnitInMm, AnyLetterCaseAndLongNames) {
  EXPECT_EQ(unit_in_mm("mm"), 1);
  EXPECT_EQ(unit_in_mm("METRE"), 1000);
  EXPECT_EQ(unit_in_mm("Inch"), 25.4);
  EXPECT_EQ(unit_in_mm("inches"), 25.4);
  EXPECT_EQ(unit_in_mm("millimetres"), 1);
  EXPECT_EQ(unit_in_mm("Ft"), 304.8);
  EXPECT_EQ(unit_in_mm("um"), 1e-3);
  EXPECT_EQ(unit_in_mm(""), std::nullopt);
  EXPECT_EQ(unit_in_mm("parsec"), std::nullopt);
}

}  // namespace
}  // namespace catoptra::cad_import
