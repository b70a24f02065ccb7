// The JSON that `render`, `compare` and `bench` write; docs/reports.md describes every field.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/comparison.h"
#include "render/frame.h"
#include "render/renderer.h"

namespace catoptra::app {

/// Stands for the infinite PSNR of two identical pictures, which JSON cannot hold.
inline constexpr double kIdenticalPsnr_db = 200;

[[nodiscard]] nlohmann::ordered_json quantiles_json(const render::ErrorQuantiles& quantiles);

/// Share of the optic's pixels that exact rays give: 1 where the mode traces all, 0 where it traces none.
/// `optic`: what the frame tells of it.
[[nodiscard]] double retraced_fraction(render::Mode mode, const render::OpticStats& optic);

/// One entry per optic of the scene. `stats`: what the frame tells of its optics (a mode that treats no optic
/// apart tells nothing). `errors` adds pixels and errors and may be null. `mode` tells which share of the
/// optic's pixels is traced exactly.
[[nodiscard]] nlohmann::ordered_json optics_json(const render::Scene& scene, render::Mode mode,
                                                 const render::FrameStats& stats,
                                                 const std::vector<render::OpticError>* errors);

/// One entry per map of mode pvrr, of optics in the picture and in each other.
[[nodiscard]] nlohmann::ordered_json maps_json(const render::FrameStats& stats);

/// What shadows have cost in the raster modes: counts of render::ShadowStats.
[[nodiscard]] nlohmann::ordered_json shadows_json(const render::FrameStats& stats);

/// Mode `auto`: which mode drew, and why.
[[nodiscard]] nlohmann::ordered_json choice_json(const render::ModeChoice& choice);

/// The mode that drew a picture for which `asked` was asked.
[[nodiscard]] render::Mode drawn_mode(render::Mode asked, const render::RenderResult& result);

[[nodiscard]] nlohmann::ordered_json image_json(const render::ImageError& image);

/// What was used: Catoptra's version, the compiler and the libraries of this folder.
[[nodiscard]] nlohmann::ordered_json versions_json();

/// Indented text with a newline at the end; bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

}  // namespace catoptra::app
