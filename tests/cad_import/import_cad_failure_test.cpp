// Bad files, cancellation, progress, and the fence around the kernel's global state.
#include <gtest/gtest.h>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepTools.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>

#include <algorithm>
#include <atomic>
#include <functional>
#include <sstream>
#include <stdexcept>

#include "cad_import/import.h"
#include "cad_import/src/file_checks.h"
#include "tests/cad_import/cad_files.h"

namespace catoptra::cad_import {
namespace {

// The reason with which `file` is refused; empty where it is read.
std::string refusal(const std::filesystem::path& file) {
  try {
    (void)import_cad(file);
  } catch (const ImportError& error) {
    EXPECT_EQ(error.file(), file.string());
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
    return error.reason();
  }
  return {};
}

TEST(ImportCadFailure, SaysWhyAFileIsRefused) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal(folder / "missing.step"), "no such file");
  test::write_text(folder / "empty.step", "");
  EXPECT_EQ(refusal(folder / "empty.step"), "is empty (0 bytes)");
  test::write_text(folder / "pointer.stp",
                   "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n");
  EXPECT_NE(refusal(folder / "pointer.stp").find("git-LFS pointer"), std::string::npos);
  test::write_box(folder / "box.step");
  const std::string text = test::read_text(folder / "box.step");
  test::write_text(folder / "cut.step", text.substr(0, text.size() * 6 / 10));
  EXPECT_NE(refusal(folder / "cut.step").find("cut off"), std::string::npos);
  test::write_text(folder / "noise.brep",
                   "DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\nLocations 9\n");
  testing::internal::CaptureStdout();
  EXPECT_NE(refusal(folder / "noise.brep").find("the section"), std::string::npos);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  test::write_text(folder / "noise.igs", std::string(200, 'x'));
  EXPECT_FALSE(refusal(folder / "noise.igs").empty());
  EXPECT_FALSE(refusal(folder.path()).empty());
}

TEST(ImportCadFailure, EveryCutOfAFileIsRefusedOrReadButNeverCrashes) {
  const ScratchFolder folder;
  test::write_box(folder / "box.step");
  const std::string text = test::read_text(folder / "box.step");
  for (std::size_t length = 1; length < text.size(); length += text.size() / 40 + 1) {
    test::write_text(folder / "cut.step", text.substr(0, length));
    EXPECT_FALSE(refusal(folder / "cut.step").empty()) << length;
  }
}

// The kernel's own reader never comes back from a text that ends within its list of shapes.
TEST(ImportCadFailure, EveryCutOfABrepIsRefused) {
  const ScratchFolder folder;
  std::ostringstream whole;
  BRepTools::Write(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), whole);
  const std::string text = whole.str();
  test::write_text(folder / "whole.brep", text);
  EXPECT_EQ(refusal(folder / "whole.brep"), "");
  testing::internal::CaptureStdout();
  for (std::size_t length = 1; length < text.size() - 8; length += text.size() / 60 + 1) {
    test::write_text(folder / "cut.brep", text.substr(0, length));
    EXPECT_FALSE(refusal(folder / "cut.brep").empty()) << length;
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(ImportCadFailure, FileWithoutFacesSaysSo) {
  const ScratchFolder folder;
  test::CadDocument document;
  document.add(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Shape(), "Line");
  document.write_step(folder / "line.step");
  EXPECT_NE(refusal(folder / "line.step").find("no face"), std::string::npos);
}

TEST(ImportCadFailure, NamesTheExternalFilesThatAreMissing) {
  const ScratchFolder folder;
  test::CadDocument document;
  const TDF_Label part = document.add(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "Wheel");
  const TDF_Label car = document.shapes->NewShape();
  TDataStd_Name::Set(car, "Car");
  document.shapes->AddComponent(car, part, TopLoc_Location());
  document.write_step(folder / "car.step", "MM", true);
  int parts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    if (entry.path().filename() != "car.step") parts += std::filesystem::remove(entry.path());
  ASSERT_EQ(parts, 1);
  const std::string reason = refusal(folder / "car.step");
  EXPECT_NE(reason.find("other file"), std::string::npos) << reason;
  EXPECT_NE(reason.find("Wheel"), std::string::npos) << reason;
}

TEST(ImportCadProgress, RisesToOneAndNamesItsStages) {
  const ScratchFolder folder;
  test::write_box(folder / "box.step");
  std::vector<double> shares;
  std::vector<std::string> stages;
  ImportOptions options;
  options.progress = [&](double share, std::string_view stage) {
    shares.push_back(share);
    if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
  };
  (void)import_cad(folder / "box.step", options);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_EQ(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
  EXPECT_EQ(stages, (std::vector<std::string>{"reading", "converting", "analysing", "done"}));
}

TEST(ImportCadProgress, CancelStopsInEveryStage) {
  const ScratchFolder folder;
  test::write_box(folder / "box.step");
  for (const char* stop_at : {"reading", "converting", "analysing"}) {
    std::atomic<bool> cancel = false;
    ImportOptions options;
    options.cancel = &cancel;
    options.progress = [&](double, std::string_view stage) {
      EXPECT_FALSE(cancel) << "reported on after the cancel";
      if (stage == stop_at) cancel = true;
    };
    EXPECT_THROW((void)import_cad(folder / "box.step", options), Cancelled) << stop_at;
  }
}

TEST(ImportCadProgress, WhatTheCallbackThrowsComesOut) {
  const ScratchFolder folder;
  test::write_box(folder / "box.step");
  for (const char* stop_at : {"reading", "converting", "analysing"}) {
    ImportOptions options;
    options.progress = [&](double share, std::string_view stage) {
      if (stage == stop_at && share > 0.45) throw std::logic_error("window closed");
      if (stage == stop_at && stage == "reading") throw std::logic_error("window closed");
    };
    EXPECT_THROW((void)import_cad(folder / "box.step", options), std::logic_error) << stop_at;
  }
}

TEST(KernelSession, PutsSettingsAndPrintersBackAndKeepsQuiet) {
  const ScratchFolder folder;
  test::write_box(folder / "box.step");
  test::write_text(folder / "cut.step", test::read_text(folder / "box.step").substr(0, 3000));
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "M");
  const int printers = Message::DefaultMessenger()->Printers().Size();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  (void)import_cad(folder / "box.step");
  EXPECT_THROW((void)import_cad(folder / "cut.step"), ImportError);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_STREQ(Interface_Static::CVal("xstep.cascade.unit"), "M");
  EXPECT_EQ(Message::DefaultMessenger()->Printers().Size(), printers);
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
}

TEST(FileChecks, UnitNames) {
  EXPECT_EQ(normalized_unit("MILLIMETRE"), "mm");
  EXPECT_EQ(normalized_unit("Metre"), "m");
  EXPECT_EQ(normalized_unit("inch"), "in");
  EXPECT_EQ(normalized_unit("furlong"), "furlong");
  EXPECT_EQ(file_unit_in_mm(normalized_unit("Mil")), 0.0254);
  EXPECT_EQ(file_unit_in_mm("furlong"), std::nullopt);
}

// Examples of ISO 10303-21:2016, 6.4.3.
TEST(FileChecks, StepStringEscapes) {
  EXPECT_EQ(decoded_step_string("see \\X\\A7 4.1"), "see \xC2\xA7 4.1");
  EXPECT_EQ(decoded_step_string("\\X2\\03C0\\X0\\ is pi"), "\xCF\x80 is pi");
  EXPECT_EQ(decoded_step_string("\\X4\\0001F600\\X0\\"), "\xF0\x9F\x98\x80");
  EXPECT_EQ(decoded_step_string("\\X2\\D83DDE00\\X0\\"), "\xF0\x9F\x98\x80");
  EXPECT_EQ(decoded_step_string("\\S\\d"), "\xC3\xA4");
  EXPECT_EQ(decoded_step_string("a\\\\b"), "a\\b");
  EXPECT_EQ(decoded_step_string("broken \\X2\\03"), "broken 03");
}

}  // namespace
}  // namespace catoptra::cad_import
