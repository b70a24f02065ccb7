// What a lens is made of, as a scene file says it.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "app/src/toml_table.h"
#include "optics/medium.h"

namespace catoptra::app {

/// The glasses of a catalogue (.agf), or the one of a refractiveindex.info file (.yml). Throws
/// catoptra::Error where the file cannot be read.
[[nodiscard]] std::vector<optics::Medium> glasses_of_file(const std::filesystem::path& file);

/// The built-in media and, where `file` is not empty, those of a glass catalogue (.agf) or of one material of
/// the refractiveindex.info database (.yml). Throws catoptra::Error where the file cannot be read.
[[nodiscard]] optics::MediumCatalogue lens_media(const std::filesystem::path& file);

/// The medium under `key` of a [[lens]]: a name of `media`, { nd, vd }, { rgb = [R, G, B] } (the indices at
/// the wavelengths of the three colour masks: C, e and F) or { sellmeier = [B1, C1, B2, C2, ...] } with C in
/// square micrometres. Nullopt where the key is absent. Throws catoptra::Error with file, line and key where
/// the name is unknown (with the nearest ones) or the index is below 1 or undefined anywhere from 390 to
/// 720 nm.
[[nodiscard]] std::optional<optics::Medium> read_medium(const TomlTable& lens, std::string_view key,
                                                        const optics::MediumCatalogue& media);

}  // namespace catoptra::app
