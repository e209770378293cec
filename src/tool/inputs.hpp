// What several subcommands read: options of the search, images that must fit the rig, workers.
// Errors name the file and say what is wanted. Normal thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/camera/image.hpp"
#include "platform/base/command_line.hpp"
#include "platform/base/parallel.hpp"
#include "platform/base/result.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/track/track_config.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::tool {

Argument rig_option();
std::vector<Argument> search_options(const std::string& depths = "z-mm");  // its option's name
Argument simd_option();
std::vector<Argument> joined(std::vector<Argument> a, const std::vector<Argument>& b);

// What search_options() say. fitness and optimiser fit the kind of target.
Result<track::TrackConfig> search_config(const Arguments& arguments, bool rectangle,
                                         const std::string& depths = "z-mm");

// which: "left" or "right", for the error.
Result<hal::Image> read_camera_image(const std::string& path, const Intrinsics& camera,
                                     const std::string& which);

Result<vision::PatchModel> read_model(const std::string& path, const track::TrackConfig& config);

// The .gannet files of a folder, by name. Error: no such folder.
Result<std::vector<std::string>> model_files(const std::string& folder);

// "none", or at which rolls a target looks like itself.
std::string rolls_text(const vision::Symmetry& symmetry);

// A pool of so many threads, the caller among them; 0: as many as there are cores.
Result<std::unique_ptr<Parallel>> make_workers(int threads);

// "gannet locate: text" on standard error, for each of its lines.
void tell(const std::string& command, const std::string& text);

}  // namespace gannet::tool
