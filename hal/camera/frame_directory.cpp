#include "hal/camera/frame_directory.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "platform/linux/whole_file.hpp"

namespace gannet::hal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTimesBytes = 64 << 20;

bool is_image_name(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return path.filename().string().front() != '.' &&
         (ending == ".png" || ending == ".jpg" || ending == ".jpeg");
}

Result<std::vector<fs::path>> list_images(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> images;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (is_image_name(it->path())) images.push_back(it->path());
  if (error) return Error{folder.string() + ": cannot list: " + error.message()};
  if (images.empty()) return Error{folder.string() + ": no .png, .jpg or .jpeg file in it"};
  std::sort(images.begin(), images.end(), [](const fs::path& a, const fs::path& b) {
    return a.filename().string() < b.filename().string();
  });
  return images;
}

std::set<std::string> stems(const std::vector<fs::path>& images) {
  std::set<std::string> names;
  for (const fs::path& image : images) names.insert(image.stem().string());
  return names;
}

// The first image whose name the other side lacks.
const fs::path* without_twin(const std::vector<fs::path>& images,
                             const std::set<std::string>& others) {
  for (const fs::path& image : images)
    if (!others.contains(image.stem().string())) return &image;
  return nullptr;
}

// Two sides that share names must share all of them: a lost file must not shift the rest. Sides
// that share none (left_0001 beside right_0001) are paired by order.
Result<void> check_pairs(const std::vector<fs::path>& left, const std::vector<fs::path>& right) {
  const auto left_stems = stems(left), right_stems = stems(right);
  const bool share = std::any_of(left_stems.begin(), left_stems.end(),
                                 [&](const auto& stem) { return right_stems.contains(stem); });
  if (share) {
    if (const auto* lonely = without_twin(left, right_stems))
      return Error{lonely->string() + ": no right image of that name"};
    if (const auto* lonely = without_twin(right, left_stems))
      return Error{lonely->string() + ": no left image of that name"};
  }
  if (left.size() != right.size())
    return Error{left[0].parent_path().string() + ": " + std::to_string(left.size()) +
                 " left images but " + std::to_string(right.size()) + " right ones"};
  return {};
}

std::optional<std::int64_t> number_at_end(std::string_view name) {
  std::size_t digits = 0;
  while (digits < name.size() && digits < 18 &&
         std::isdigit(static_cast<unsigned char>(name[name.size() - 1 - digits])) != 0)
    ++digits;
  if (digits == 0) return std::nullopt;
  std::int64_t number = 0;
  for (char c : name.substr(name.size() - digits)) number = 10 * number + (c - '0');
  return number;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0)
    text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0)
    text.remove_suffix(1);
  return text;
}

// Each pair's time by name or number. False: some pair or row has no partner.
bool match_by_name(const std::vector<FrameTime>& rows, std::vector<FramePair>& pairs) {
  std::map<std::string, std::size_t> by_name;
  std::map<std::int64_t, std::size_t> by_number;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    by_name[pairs[i].name] = i;
    if (const auto number = number_at_end(pairs[i].name)) by_number[*number] = i;
  }
  std::vector<bool> matched(pairs.size());
  for (const FrameTime& row : rows) {
    const auto named = by_name.find(row.frame);
    const auto number = number_at_end(row.frame);
    const auto numbered = number ? by_number.find(*number) : by_number.end();
    if (named == by_name.end() && numbered == by_number.end()) return false;
    const std::size_t pair = named != by_name.end() ? named->second : numbered->second;
    matched[pair] = true;
    pairs[pair].time_s = row.time_s;
  }
  return std::find(matched.begin(), matched.end(), false) == matched.end();
}

Result<void> read_times(const std::string& path, std::vector<FramePair>& pairs) {
  const auto bytes = linux_os::read_file(path, kMaxTimesBytes);
  if (!bytes) return bytes.error();
  const auto rows =
      parse_frame_times(path, {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  if (!rows) return rows.error();
  if (!match_by_name(*rows, pairs)) {
    if (rows->size() != pairs.size())
      return Error{path + ": " + std::to_string(rows->size()) + " rows for " +
                   std::to_string(pairs.size()) + " pairs, and their names do not fit"};
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].time_s = (*rows)[i].time_s;
  }
  for (std::size_t i = 1; i < pairs.size(); ++i)
    if (!(pairs[i].time_s > pairs[i - 1].time_s))
      return Error{path + ": the time of '" + pairs[i].name + "' is not after that of '" +
                   pairs[i - 1].name + "', the pair before it by name"};
  return {};
}

}  // namespace

Result<std::vector<FrameTime>> parse_frame_times(const std::string& path, std::string_view text) {
  std::vector<FrameTime> rows;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view row = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string where = path + ":" + std::to_string(line) + ": ";
    if (line == 1 && row != "frame,time_s")
      return Error{where + "the first line must be `frame,time_s`"};
    if (line == 1 || row.empty()) continue;
    const std::size_t comma = row.find(',');
    if (comma == std::string_view::npos) return Error{where + "expected `frame,time_s`"};
    const std::string_view number = trimmed(row.substr(comma + 1));
    double time_s = 0;
    const auto [stop, problem] =
        std::from_chars(number.data(), number.data() + number.size(), time_s);
    // Beyond 1e8 s (three years) nanoseconds lose their meaning in a double.
    if (problem != std::errc() || stop != number.data() + number.size() ||
        !(std::abs(time_s) < 1e8))
      return Error{where + "'" + std::string(number) + "' is not a time in seconds"};
    if (!rows.empty() && !(time_s > rows.back().time_s))
      return Error{where + "times must rise from row to row"};
    rows.push_back({std::string(trimmed(row.substr(0, comma))), time_s});
  }
  return rows;
}

Result<FrameDirectory> list_frames(const std::string& directory, double rate_hz) {
  const fs::path root(directory);
  const auto left = list_images(root / "left");
  if (!left) return left.error();
  const auto right = list_images(root / "right");
  if (!right) return right.error();
  if (const auto checked = check_pairs(*left, *right); !checked) return checked.error();
  FrameDirectory frames;
  for (std::size_t i = 0; i < left->size(); ++i)
    frames.pairs.push_back({(*left)[i].stem().string(), (*left)[i].string(), (*right)[i].string(),
                            static_cast<double>(i) / rate_hz});
  const fs::path times = root / "times.csv";
  frames.has_times = fs::exists(times);
  if (frames.has_times)
    if (const auto read = read_times(times.string(), frames.pairs); !read) return read.error();
  const double span_s = frames.pairs.back().time_s - frames.pairs.front().time_s;
  frames.interval_s =
      frames.pairs.size() > 1 ? span_s / static_cast<double>(frames.pairs.size() - 1) : 1 / rate_hz;
  return frames;
}

}  // namespace gannet::hal
