// Bad FreeCAD documents: each is refused in one line that names file and entry, or read; never worse.
#include <gtest/gtest.h>
#include <BRepPrimAPI_MakeBox.hxx>

#include <functional>
#include <iostream>
#include <random>

#include "cad_import/import.h"
#include "tests/cad_import/cad_files.h"
#include "tests/cad_import/freecad_files.h"

namespace catoptra::cad_import {
namespace {

using test::FreecadFile;

TopoDS_Shape box() {
  return BRepPrimAPI_MakeBox(1, 2, 3).Shape();
}

/// "ENTITY: REASON" with which `file` is refused; empty where it is read.
std::string refusal(const std::filesystem::path& file) {
  try {
    (void)import_cad(file);
  } catch (const ImportError& error) {
    EXPECT_EQ(error.file(), file.string());
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
    EXPECT_FALSE(error.hint().empty()) << error.what();
    return error.entity() + ": " + error.reason();
  }
  return {};
}

void expect_says(const std::filesystem::path& file, const std::string& words) {
  const std::string said = refusal(file);
  EXPECT_NE(said.find(words), std::string::npos) << "\"" << said << "\" does not say \"" << words << "\"";
}

FreecadFile one_box() {
  FreecadFile file;
  file.shape("Part::Box", "Box", "Box", box());
  return file;
}

TEST(FreecadDamage, ArchiveThatIsNoneOrCutOffOrOfSomethingElse) {
  const ScratchFolder folder;
  test::write_text(folder / "text.FCStd", "not an archive");
  expect_says(folder / "text.FCStd", "is not a FreeCAD document: it is no ZIP archive");
  const auto whole = one_box().write(folder / "whole.FCStd");
  EXPECT_EQ(refusal(whole), "");
  const std::string bytes = test::read_text(whole);
  for (const double share : {0.3, 0.7, 0.99}) {
    test::write_text(folder / "cut.FCStd", bytes.substr(0, std::size_t(share * double(bytes.size()))));
    expect_says(folder / "cut.FCStd", "the FreeCAD document is cut off or damaged");
  }
  test::write_zip(folder / "other.FCStd", {{"readme.txt", "hello"}});
  expect_says(folder / "other.FCStd", "Document.xml: is missing");
  test::write_zip(folder / "other.zip", {{"readme.txt", "hello"}});
  EXPECT_EQ(sniff_format(folder / "other.zip"), FileFormat::unknown);
  test::write_zip(folder / "late.zip", {{"readme.txt", "hello"}, {"Document.xml", one_box().document_xml()}});
  EXPECT_EQ(sniff_format(folder / "late.zip"), FileFormat::freecad);
}

TEST(FreecadDamage, XmlThatIsBrokenOrEmpty) {
  const ScratchFolder folder;
  FreecadFile file = one_box();
  test::write_zip(folder / "a.FCStd", {{"Document.xml", file.document_xml().substr(0, 400)}});
  expect_says(folder / "a.FCStd", "Document.xml: is broken XML");
  test::write_zip(folder / "b.FCStd", {{"Document.xml", "<?xml version='1.0'?><html/>"}});
  expect_says(folder / "b.FCStd", "Document.xml: has no element Document");
  test::write_zip(folder / "c.FCStd", {{"Document.xml", ""}});
  expect_says(folder / "c.FCStd", "Document.xml: ");
  test::write_zip(folder / "d.FCStd",
                  {{"Document.xml", file.document_xml()}, {"GuiDocument.xml", "<Document"}});
  expect_says(folder / "d.FCStd", "GuiDocument.xml: is broken XML");
  expect_says(FreecadFile().write(folder / "e.FCStd"), "no face in it");
  FreecadFile bad_number;
  bad_number.shape(
      "Part::Box", "Box", "Cube", box(),
      test::property("Placement", "App::PropertyPlacement",
                     R"(<PropertyPlacement Px="nan" Py="0" Pz="0" Q0="0" Q1="0" Q2="0" Q3="1"/>)"));
  expect_says(bad_number.write(folder / "f.FCStd"), "the Placement of \"Cube\" is not made of numbers");
  std::string deep = "<Document>";
  for (int i = 0; i < 200'000; ++i) deep += "<a>";
  test::write_zip(folder / "g.FCStd", {{"Document.xml", deep}});
  expect_says(folder / "g.FCStd", "is broken XML");
}

TEST(FreecadDamage, ShapeThatIsMissingOrBrokenIsNamed) {
  const ScratchFolder folder;
  FreecadFile missing;
  missing.object("Part::Box", "Box", "Cube", test::shape_property("Box.Shape.brp"));
  expect_says(missing.write(folder / "a.FCStd"), "Box.Shape.brp (\"Cube\"): is missing from the document");
  FreecadFile outside;  // a path in a name is a name like any other
  test::write_text(folder / "secret.brp", test::brep_text(box()));
  outside.object("Part::Box", "Box", "Cube",
                 test::shape_property("../" + folder.path().filename().string() + "/secret.brp"));
  expect_says(outside.write(folder / "b.FCStd"), "is missing from the document");
  for (const std::string& bytes : {std::string("noise"), test::brep_text(box()).substr(0, 1500)}) {
    FreecadFile broken;
    broken.object("Part::Box", "Box", "Cube", test::shape_property("Box.Shape.brp"));
    broken.entries.emplace_back("Box.Shape.brp", bytes);
    expect_says(broken.write(folder / "c.FCStd"), "Box.Shape.brp (\"Cube\"): is cut off or damaged");
  }
}

TEST(FreecadDamage, ObjectsThatHoldThemselvesAreNamed) {
  const ScratchFolder folder;
  FreecadFile links;
  links.object("App::Link", "A", "first", test::x_link("B"));
  links.object("App::Link", "B", "second", test::x_link("A"));
  expect_says(links.write(folder / "a.FCStd"), "holds or shows itself (first > second > first)");
  FreecadFile parts;
  const auto part = [&](const std::string& name, const std::string& member) {
    parts.object("App::Part", name, name,
                 test::link("Origin", "O" + name) + test::link_list("Group", {member}));
  };
  part("P", "Q");
  part("Q", "L");
  parts.object("App::Link", "L", "L", test::x_link("P"));
  expect_says(parts.write(folder / "b.FCStd"), "holds or shows itself (P > Q > L > P)");
  FreecadFile by_label;  // around the ring by a path of labels
  by_label.object("App::Link", "A", "a", test::x_link("Box", "", "$b."));
  by_label.object("App::Link", "B", "b", test::x_link("Box", "", "$a."));
  by_label.shape("Part::Box", "Box", "Box", box());
  expect_says(by_label.write(folder / "c.FCStd"), "is nested more than 200 deep");
  FreecadFile nowhere;
  nowhere.object("App::Link", "A", "a", test::x_link("Gone"));
  expect_says(nowhere.write(folder / "d.FCStd"), "is a link to \"Gone\", which is not in the document");
}

TEST(FreecadDamage, WhatWouldFillTheMemoryIsRefused) {
  const ScratchFolder folder;
  FreecadFile bomb;
  bomb.object("Part::Box", "Box", "Cube", test::shape_property("Box.Shape.brp"));
  bomb.entries.emplace_back("Box.Shape.brp", std::string(32 << 20, ' '));
  expect_says(bomb.write(folder / "a.FCStd"), "unpacks to 32 MB from almost nothing");
  FreecadFile arrays;  // ten of ten of ten ...
  arrays.shape("Part::Box", "L0", "L0", box(), "", false);
  const auto level = [](int i) { return std::string("L").append(std::to_string(i)); };
  for (int i = 1; i <= 9; ++i)
    arrays.object(
        "App::Link", level(i), level(i),
        test::x_link(level(i - 1)) +
            test::property("ElementCount", "App::PropertyIntegerConstraint", R"(<Integer value="10"/>)"),
        i == 9);
  expect_says(arrays.write(folder / "b.FCStd"), "shows more than 100000 shapes");
}

TEST(FreecadDamage, ChangedBytesAreReadOrRefusedInOneLine) {
  constexpr unsigned kSeed = 20261124;
  std::cout << "seed " << kSeed << "\n";
  std::mt19937 random(kSeed);
  const ScratchFolder folder;
  int read = 0, refused = 0;
  for (const bool packed : {true, false}) {
    const std::string whole = test::read_text(one_box().write(folder / "whole.FCStd", true, packed));
    for (int round = 0; round < 150; ++round) {
      std::string bytes = whole;
      for (auto n = 1 + random() % 8; n > 0; --n)
        bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
      test::write_text(folder / "damaged.FCStd", bytes);
      try {
        (void)import_cad(folder / "damaged.FCStd");
        ++read;
      } catch (const ImportError& error) {
        ++refused;
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_GT(read, 0);     // where the archive's own notes were hit, and not what they are about
  EXPECT_GT(refused, 0);  // the checksums see the rest
}

/// With XML and checksums intact but for the numbers and names in them.
TEST(FreecadDamage, ChangedXmlIsReadOrRefusedInOneLine) {
  constexpr unsigned kSeed = 20261125;
  std::cout << "seed " << kSeed << "\n";
  std::mt19937 random(kSeed);
  const ScratchFolder folder;
  FreecadFile file;
  file.object(
      "App::Part", "Part", "Part",
      test::placement(1, 2, 3) + test::link("Origin", "O") + test::link_list("Group", {"Box", "Link"}));
  file.shape("Part::Box", "Box", "Box", box(), test::placement(0, 0, 5));
  file.object("App::Link", "Link", "copy",
              test::x_link("Box", "", "Box.") + test::placement(0, 0, 9, "LinkPlacement"));
  int read = 0, refused = 0;
  for (int round = 0; round < 300; ++round) {
    std::string xml = file.document_xml();
    for (auto n = 1 + random() % 3; n > 0; --n) {
      const std::size_t at = random() % xml.size(), quote = xml.find('"', at);
      const std::size_t change = random() % 2 == 0 && quote + 1 < xml.size() ? quote + 1 : at;
      xml[change] = "0123456789-.e\"<>/$ABL"[random() % 21];
    }
    test::write_zip(folder / "damaged.FCStd", {{"Document.xml", xml}, file.entries[0]}, false);
    try {
      (void)import_cad(folder / "damaged.FCStd");
      ++read;
    } catch (const ImportError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(read, 0);
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace catoptra::cad_import
