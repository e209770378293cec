#include "src/world/kept_frames.hpp"

#include <cstdio>
#include <filesystem>

#include "platform/linux/whole_file.hpp"
#include "src/image_file/image_file.hpp"

namespace gannet::world {

Result<KeptFrames> KeptFrames::create(const std::string& folder, int every) {
  std::error_code error;
  if (every > 0)
    for (const char* eye : {"/left", "/right"}) {
      std::filesystem::remove_all(folder + eye, error);  // of an earlier run
      std::filesystem::create_directories(folder + eye, error);
      if (error) return Error{folder + eye + ": " + error.message()};
    }
  return KeptFrames(folder, every);
}

void KeptFrames::take(std::uint64_t number, double time_s, const hal::ImageView& left,
                      const hal::ImageView& right) {
  if (every_ <= 0 || (number - 1) % static_cast<std::uint64_t>(every_) != 0) return;
  char name[32];
  std::snprintf(name, sizeof name, "%08llu", static_cast<unsigned long long>(number));
  char row[64];
  std::snprintf(row, sizeof row, "%s,%.6f\n", name, time_s);
  times_ += row;
  const auto file = [&](const char* eye) { return folder_ + eye + name + ".jpg"; };
  const bool written = image_file::write_jpeg(file("/left/"), left) &&
                       image_file::write_jpeg(file("/right/"), right) &&
                       linux_os::write_file(folder_ + "/times.csv", times_);
  failures_ += written ? 0 : 1;
}

}  // namespace gannet::world
