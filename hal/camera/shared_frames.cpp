#include "hal/camera/shared_frames.hpp"

#include <signal.h>
#include <unistd.h>

#include <bit>
#include <cerrno>

namespace gannet::hal {
namespace {

constexpr auto kMagic =
    std::bit_cast<std::uint64_t>(std::array<char, 8>{'G', 'A', 'N', 'N', 'E', 'T', 'F', 'R'});
constexpr std::uint32_t kFormat = 1;
constexpr std::size_t kPage = 4096;
constexpr int kMaxSlots = 64;  // of a LeasePool

enum Phase : std::uint64_t { kFree = 0, kWriting = 1, kPublished = 2, kHeld = 3 };
constexpr std::uint64_t word_of(std::uint64_t number, Phase phase) { return number << 2 | phase; }
constexpr Phase phase_of(std::uint64_t word) { return static_cast<Phase>(word & 3); }
constexpr std::uint64_t number_of(std::uint64_t word) { return word >> 2; }

std::size_t data_offset(int slots) {
  const std::size_t head =
      sizeof(SharedHeader) + static_cast<std::size_t>(slots) * sizeof(SharedSlot);
  return (head + kPage - 1) / kPage * kPage;
}

std::size_t image_offset(const ImageLayout& layout, int slots, int slot, int side) {
  return data_offset(slots) +
         (2 * static_cast<std::size_t>(slot) + static_cast<std::size_t>(side)) * layout.bytes;
}

std::size_t total_bytes(const ImageLayout& layout, int slots) {
  return image_offset(layout, slots, slots, 0);
}

SharedHeader& header_in(linux_os::MappedMemory& memory) {
  return *reinterpret_cast<SharedHeader*>(memory.data());
}

SharedSlot& slot_in(linux_os::MappedMemory& memory, int index) {
  return *reinterpret_cast<SharedSlot*>(memory.data() + sizeof(SharedHeader) +
                                        static_cast<std::size_t>(index) * sizeof(SharedSlot));
}

bool is_alive(std::uint32_t process) {
  return process != 0 && process <= INT32_MAX &&
         (::kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM);
}

}  // namespace

// ---- writer
// --------------------------------------------------------------------------------------

Result<SharedFramesWriter> SharedFramesWriter::create(const std::string& name,
                                                      const SharedFramesFormat& format) {
  SharedFramesWriter writer;
  writer.format_ = format;
  writer.layout_ = layout_of(format.format, format.width, format.height);
  if (writer.layout_.bytes == 0 || format.slots < 2 || format.slots > kMaxSlots)
    return Error{"shared frames '" + name + "': " + std::to_string(format.width) + " × " +
                 std::to_string(format.height) + " pixels in " + std::to_string(format.slots) +
                 " slots cannot be; sides must suit the pixel format, slots be 2 to 64"};
  const std::size_t bytes = total_bytes(writer.layout_, format.slots);
  auto memory = linux_os::MappedMemory::create(name, bytes);
  if (!memory) return memory.error();
  writer.memory_ = std::move(*memory);
  SharedHeader& header = writer.header();
  header.format = kFormat;
  header.width = static_cast<std::uint32_t>(format.width);
  header.height = static_cast<std::uint32_t>(format.height);
  header.pixel_format = static_cast<std::uint32_t>(format.format);
  header.matrix = static_cast<std::uint32_t>(format.matrix);
  header.range = static_cast<std::uint32_t>(format.range);
  header.slots = static_cast<std::uint32_t>(format.slots);
  header.total_bytes = bytes;
  // The file has its name already. The magic comes last: who opens it earlier finds none, refuses
  // the file and tries again. Release: pairs with the acquire in check_shared_frames.
  header.magic.store(kMagic, std::memory_order_release);
  return writer;
}

SharedFramesWriter::~SharedFramesWriter() {
  if (memory_.data() == nullptr) return;
  header().closed.store(1, std::memory_order_release);
  linux_os::futex_wake_all(header().published);
}

SharedHeader& SharedFramesWriter::header() const { return header_in(memory_); }
SharedSlot& SharedFramesWriter::slot(int index) const { return slot_in(memory_, index); }

bool SharedFramesWriter::has_reader() const {
  return header().reader.load(std::memory_order_acquire) != 0;
}

bool SharedFramesWriter::take_free_slot() {
  for (int i = 1; i <= format_.slots; ++i) {
    const int index = (last_ + i) % format_.slots;
    // Acquire pairs with the reader's release when it gave the slot back.
    std::uint64_t word = slot(index).word.load(std::memory_order_acquire);
    if (phase_of(word) == kFree &&
        slot(index).word.compare_exchange_strong(word, word_of(number_, kWriting),
                                                 std::memory_order_acq_rel)) {
      current_ = index;
      return true;
    }
  }
  return false;
}

bool SharedFramesWriter::take_oldest_unread() {
  // The reader may take one while we look; then look again, at most once for each slot.
  for (int attempt = 0; attempt < format_.slots; ++attempt) {
    int oldest = -1;
    std::uint64_t oldest_word = 0;
    for (int i = 0; i < format_.slots; ++i) {
      const std::uint64_t word = slot(i).word.load(std::memory_order_acquire);
      if (phase_of(word) != kPublished || (oldest >= 0 && word >= oldest_word)) continue;
      oldest = i;
      oldest_word = word;
    }
    if (oldest < 0) return take_free_slot();
    if (slot(oldest).word.compare_exchange_strong(oldest_word, word_of(number_, kWriting),
                                                  std::memory_order_acq_rel)) {
      ++dropped_;
      current_ = oldest;
      return true;
    }
  }
  return false;
}

std::optional<SharedFramesWriter::Images> SharedFramesWriter::begin_frame() {
  if (current_ < 0) {
    ++number_;
    if (!take_free_slot() && !take_oldest_unread()) {
      ++dropped_;
      return std::nullopt;
    }
  }
  auto* base = reinterpret_cast<std::uint8_t*>(memory_.data());
  return Images{{base + image_offset(layout_, format_.slots, current_, 0), layout_.bytes},
                {base + image_offset(layout_, format_.slots, current_, 1), layout_.bytes}};
}

void SharedFramesWriter::publish(TimePoint capture, TimePoint available) {
  if (current_ < 0) return;
  SharedSlot& written = slot(current_);
  written.capture_ns.store(to_ns(capture), std::memory_order_relaxed);
  written.available_ns.store(to_ns(available), std::memory_order_relaxed);
  // Release: pixels and times are whole before the reader sees the phase.
  written.word.store(word_of(number_, kPublished), std::memory_order_release);
  last_ = std::exchange(current_, -1);
  header().published.fetch_add(1, std::memory_order_release);
  linux_os::futex_wake_all(header().published);
}

// ---- reader
// --------------------------------------------------------------------------------------

Result<SharedFramesFormat> check_shared_frames(std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof(SharedHeader)) return Error{"too short for a header"};
  const auto& header = *reinterpret_cast<const SharedHeader*>(bytes.data());
  if (header.magic.load(std::memory_order_acquire) != kMagic)
    return Error{"not a file of shared frames"};
  if (header.format != kFormat)
    return Error{"format " + std::to_string(header.format) + ", this program knows format 1"};
  SharedFramesFormat format;
  // Copied first: the other process could change them between check and use.
  const std::uint32_t width = header.width, height = header.height, slots = header.slots;
  const std::uint32_t pixels = header.pixel_format, matrix = header.matrix, range = header.range;
  if (width > kMaxImageSide || height > kMaxImageSide || slots < 2 || slots > kMaxSlots ||
      pixels > static_cast<std::uint32_t>(PixelFormat::kRgb24) || matrix > 1 || range > 1)
    return Error{"a header with impossible values"};
  format.width = static_cast<int>(width);
  format.height = static_cast<int>(height);
  format.slots = static_cast<int>(slots);
  format.format = static_cast<PixelFormat>(pixels);
  format.matrix = static_cast<ColourMatrix>(matrix);
  format.range = static_cast<ColourRange>(range);
  const ImageLayout layout = layout_of(format.format, format.width, format.height);
  if (layout.bytes == 0) return Error{"an image size that does not suit its pixel format"};
  const std::size_t total = total_bytes(layout, format.slots);
  if (header.total_bytes != total || bytes.size() != total)
    return Error{std::to_string(bytes.size()) + " bytes long, its header asks for " +
                 std::to_string(total)};
  return format;
}

Result<std::unique_ptr<SharedFramesReader>> SharedFramesReader::open(const std::string& name) {
  auto memory = linux_os::MappedMemory::open(name, true);
  if (!memory) return memory.error();
  const auto format = check_shared_frames({memory->data(), memory->size()});
  if (!format) return Error{memory->path() + ": " + format.error().text};
  std::atomic<std::uint32_t>& reader = header_in(*memory).reader;
  const auto self = static_cast<std::uint32_t>(::getpid());
  std::uint32_t other = reader.load(std::memory_order_acquire);
  if ((other != self && is_alive(other)) || !reader.compare_exchange_strong(other, self))
    return Error{memory->path() + ": process " + std::to_string(other) + " reads it already"};
  return std::unique_ptr<SharedFramesReader>(new SharedFramesReader(std::move(*memory), *format));
}

SharedFramesReader::SharedFramesReader(linux_os::MappedMemory memory,
                                       const SharedFramesFormat& format)
    : memory_(std::move(memory)),
      format_(format),
      layout_(layout_of(format.format, format.width, format.height)),
      pool_(format.slots) {
  for (int i = 0; i < format_.slots; ++i) {  // what a reader before us held
    std::uint64_t word = slot(i).word.load(std::memory_order_acquire);
    if (phase_of(word) == kHeld) slot(i).word.compare_exchange_strong(word, kFree);
  }
}

SharedFramesReader::~SharedFramesReader() {
  give_back_returned();
  header().reader.store(0, std::memory_order_release);
}

SharedHeader& SharedFramesReader::header() const { return header_in(memory_); }
SharedSlot& SharedFramesReader::slot(int index) const { return slot_in(memory_, index); }

std::uint32_t SharedFramesReader::published() const {
  return header().published.load(std::memory_order_acquire);
}

void SharedFramesReader::wait(std::uint32_t seen, TimePoint until) const {
  linux_os::futex_wait(header().published, seen, until);
}

bool SharedFramesReader::closed() const {
  return header().closed.load(std::memory_order_acquire) != 0;
}

void SharedFramesReader::give_back_returned() {
  for (std::uint64_t rest = held_; rest != 0; rest &= rest - 1) {
    const int index = __builtin_ctzll(rest);
    if (!pool_.is_free(index)) continue;
    // Release: our reading is done before the writer writes.
    slot(index).word.store(kFree, std::memory_order_release);
    held_ &= ~(std::uint64_t{1} << index);
  }
}

bool SharedFramesReader::all_home() {
  give_back_returned();
  return held_ == 0;
}

std::optional<TimePoint> SharedFramesReader::next_available() const {
  std::optional<TimePoint> next;
  for (int i = 0; i < format_.slots; ++i) {
    if (phase_of(slot(i).word.load(std::memory_order_acquire)) != kPublished) continue;
    const TimePoint time = time_from_ns(slot(i).available_ns.load(std::memory_order_relaxed));
    if (!next || time < *next) next = time;
  }
  return next;
}

int SharedFramesReader::oldest_due(TimePoint now, std::uint64_t& word) const {
  int oldest = -1;
  for (int i = 0; i < format_.slots; ++i) {
    const std::uint64_t candidate = slot(i).word.load(std::memory_order_acquire);
    if (phase_of(candidate) != kPublished || (oldest >= 0 && candidate >= word)) continue;
    if (slot(i).available_ns.load(std::memory_order_relaxed) > to_ns(now)) continue;
    oldest = i;
    word = candidate;
  }
  return oldest;
}

bool SharedFramesReader::is_plausible(std::uint64_t number, std::int64_t capture_ns,
                                      std::int64_t available_ns) const {
  return number > last_number_ && capture_ns >= last_capture_ns_ && capture_ns <= available_ns;
}

void SharedFramesReader::fill(int index, StereoFrame& frame) const {
  const auto* base = reinterpret_cast<const std::uint8_t*>(memory_.data());
  const auto view = [&](int side) {
    return view_of(layout_, base + image_offset(layout_, format_.slots, index, side),
                   format_.format, format_.width, format_.height, format_.matrix, format_.range);
  };
  frame.left = view(0);
  frame.right = view(1);
}

CaptureStatus SharedFramesReader::take(TimePoint now, StereoFrame& frame) {
  give_back_returned();
  // The writer may give up the oldest one while we look: then look again.
  for (int attempt = 0; attempt < format_.slots; ++attempt) {
    std::uint64_t word = 0;
    const int index = oldest_due(now, word);
    if (index < 0) return CaptureStatus::kNothing;
    if (!slot(index).word.compare_exchange_strong(word, word_of(number_of(word), kHeld),
                                                  std::memory_order_acq_rel))
      continue;
    // The slot is ours: its times are now those of this number.
    const std::int64_t capture_ns = slot(index).capture_ns.load(std::memory_order_relaxed);
    const std::int64_t available_ns = slot(index).available_ns.load(std::memory_order_relaxed);
    const bool plausible = is_plausible(number_of(word), capture_ns, available_ns);
    Lease lease = plausible ? pool_.lend_slot(index) : Lease{};
    if (!lease.valid()) {
      // A slot that is still out keeps its phase until its lease is home.
      if ((held_ >> index & 1) == 0) slot(index).word.store(kFree, std::memory_order_release);
      return CaptureStatus::kBroken;
    }
    held_ |= std::uint64_t{1} << index;
    missed_ += last_number_ == 0 ? 0 : number_of(word) - last_number_ - 1;
    last_number_ = number_of(word);
    last_capture_ns_ = capture_ns;
    fill(index, frame);
    frame.left_lease = std::move(lease);
    frame.right_lease = Lease{};
    frame.capture_time = time_from_ns(capture_ns);
    frame.number = last_number_;
    return CaptureStatus::kFrame;
  }
  return CaptureStatus::kNothing;
}

}  // namespace gannet::hal
