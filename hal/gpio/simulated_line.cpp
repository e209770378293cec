#include "hal/gpio/simulated_line.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cassert>
#include <cstring>

#include "platform/linux/fd.hpp"

namespace gannet::hal {
namespace {

constexpr Duration kRetry = std::chrono::seconds(1);

SharedLine* lines_of(void* memory) {
  return reinterpret_cast<SharedLine*>(static_cast<char*>(memory) + sizeof(SharedLinesHeader));
}

constexpr std::size_t file_size(std::size_t lines) {
  return sizeof(SharedLinesHeader) + lines * sizeof(SharedLine);
}

bool is_good(const void* memory, std::size_t size) {
  if (size < sizeof(SharedLinesHeader)) return false;
  const auto& header = *static_cast<const SharedLinesHeader*>(memory);
  // Pairs with create's release: the lines' names are there.
  return header.magic.load(std::memory_order_acquire) == SharedLinesHeader::kMagic &&
         header.format == SharedLinesHeader::kFormat && size >= file_size(header.count);
}

SharedLine* find_line(void* memory, std::string_view name) {
  const std::uint32_t count = static_cast<const SharedLinesHeader*>(memory)->count;
  for (std::uint32_t i = 0; i < count; ++i) {
    SharedLine& line = lines_of(memory)[i];
    if (name == std::string_view(line.name, strnlen(line.name, sizeof line.name))) return &line;
  }
  return nullptr;
}

}  // namespace

// ---- a line -------------------------------------------------------------------------------------

Level SharedLine::read() const {
  const std::uint32_t value = level.load(std::memory_order_acquire);
  return value <= static_cast<std::uint32_t>(Level::kHigh) ? static_cast<Level>(value)
                                                           : Level::kUnknown;
}

void SharedLine::write(Level to, TimePoint now) {
  const Level from = read();
  if (to == from) return;
  edge_time_ns.store(to_ns(now), std::memory_order_relaxed);
  // The level last: a reader that sees it also sees its edge.
  if (to == Level::kHigh) rises.fetch_add(1, std::memory_order_release);
  if (to == Level::kLow) falls.fetch_add(1, std::memory_order_release);
  level.store(static_cast<std::uint32_t>(to), std::memory_order_release);
}

// ---- the world's side ---------------------------------------------------------------------------

Result<SimulatedLines> SimulatedLines::create(const std::string& name,
                                              const std::vector<std::string>& lines,
                                              unsigned mode) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty() || lines[i].size() >= SharedLine::kNameBytes) {
      return Error{"simulated line '" + lines[i] + "': a name has 1 to " +
                   std::to_string(SharedLine::kNameBytes - 1) + " bytes"};
    }
    for (std::size_t other = 0; other < i; ++other) {
      if (lines[other] == lines[i]) {
        return Error{"simulated line '" + lines[i] + "' is there twice"};
      }
    }
  }
  // Whoever still has an older file of that name shall notice that it is no longer in use.
  if (auto old = linux_os::MappedMemory::open(name, true);
      old && is_good(old->data(), old->size())) {
    reinterpret_cast<SharedLinesHeader*>(old->data())->magic.store(0, std::memory_order_release);
  }
  auto memory = linux_os::MappedMemory::create(name, file_size(lines.size()), mode);
  if (!memory) return memory.error();
  auto& header = *reinterpret_cast<SharedLinesHeader*>(memory->data());
  header.format = SharedLinesHeader::kFormat;
  header.count = static_cast<std::uint32_t>(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    SharedLine& line = lines_of(memory->data())[i];
    std::memcpy(line.name, lines[i].data(), lines[i].size());
    line.level.store(static_cast<std::uint32_t>(Level::kUnknown), std::memory_order_relaxed);
  }
  header.magic.store(SharedLinesHeader::kMagic, std::memory_order_release);
  return SimulatedLines(std::move(*memory), static_cast<int>(lines.size()));
}

SimulatedLines::~SimulatedLines() {
  if (memory_.data() == nullptr) return;  // moved from
  reinterpret_cast<SharedLinesHeader*>(memory_.data())->magic.store(0, std::memory_order_release);
}

int SimulatedLines::find(std::string_view line) const {
  const SharedLine* found = find_line(memory_.data(), line);
  return found == nullptr ? -1 : static_cast<int>(found - lines_of(memory_.data()));
}

SharedLine& SimulatedLines::at(int line) const {
  assert(line >= 0 && line < count_);
  return lines_of(memory_.data())[line];
}

// ---- the daemon's side --------------------------------------------------------------------------

LineMapping::LineMapping(const std::string& path, const std::string& line)
    : path_(path.find('/') == std::string::npos ? "/dev/shm/" + path : path), name_(line) {}

LineMapping::~LineMapping() { unmap(); }

SharedLine* LineMapping::line(TimePoint now) {
  if (line_ != nullptr && is_good(memory_, size_)) return line_;
  unmap();
  if (has_tried_ && now < next_attempt_) return nullptr;
  has_tried_ = true;
  next_attempt_ = now + kRetry;
  map();
  return line_;
}

// Not MappedMemory::open: that one makes an error's text, which takes memory.
void LineMapping::map() {
  const linux_os::Fd fd(::open(path_.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK));
  struct stat status = {};
  if (!fd.valid() || fstat(fd.get(), &status) != 0 || !S_ISREG(status.st_mode)) return;
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size < sizeof(SharedLinesHeader)) return;
  void* memory =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, fd.get(), 0);
  if (memory == MAP_FAILED) return;
  memory_ = memory;
  size_ = size;
  if (is_good(memory_, size_)) line_ = find_line(memory_, name_);
  if (line_ == nullptr)
    unmap();
  else
    ++mappings_;
}

void LineMapping::unmap() {
  if (memory_ != nullptr) munmap(memory_, size_);
  memory_ = nullptr;
  line_ = nullptr;
}

DigitalInput::Reading SimulatedInput::read(TimePoint now) {
  const SharedLine* line = mapping_.line(now);
  if (line == nullptr) return {};
  Reading reading;
  reading.level = line->read();  // before the counts: its edge is among them
  const std::uint32_t rises = line->rises.load(std::memory_order_acquire);
  const std::uint32_t falls = line->falls.load(std::memory_order_acquire);
  reading.edge_time = time_from_ns(line->edge_time_ns.load(std::memory_order_relaxed));
  const bool is_first = mapping_seen_ != mapping_.mappings();  // older edges were nobody's
  reading.rose = !is_first && rises != rises_;
  reading.fell = !is_first && falls != falls_;
  mapping_seen_ = mapping_.mappings();
  rises_ = rises;
  falls_ = falls;
  return reading;
}

bool SimulatedOutput::write(bool high, TimePoint now) {
  SharedLine* line = mapping_.line(now);
  if (line == nullptr) return false;
  line->write(high ? Level::kHigh : Level::kLow, now);
  return true;
}

}  // namespace gannet::hal
