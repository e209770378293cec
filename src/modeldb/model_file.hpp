// A .gannet file: one target as one file (docs/design/model-file.md): a TOML header, a line "---",
// and the photo's crop as PNG, whose channels are Y, U, V (full-range BT.601, exact) and the mask
// as alpha. Points are derived when loading, so that spacing and coarse levels need no new format.
// Normal threads only.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::modeldb {

// Errors name file, line or byte; all header problems at once.
Result<vision::PhotoPatch> load_model(const std::string& path);

// Written beside and renamed: nobody sees half of one.
Result<void> save_model(const std::string& path, const vision::PhotoPatch& patch);

// The same in memory; name stands for the file in errors.
Result<vision::PhotoPatch> decode_model(std::span<const std::uint8_t> bytes,
                                        const std::string& name);
Result<std::vector<std::uint8_t>> encode_model(const vision::PhotoPatch& patch);

// Names are what people type after `gannet target model`: 1 to 64 bytes, nothing invisible.
bool is_model_name(const std::string& name);

// The header's keys as Markdown.
std::string model_reference();

}  // namespace gannet::modeldb
