#include "hal/drive/vesc_messages.hpp"

#include <algorithm>
#include <iterator>

namespace gannet::hal::vesc {
namespace {

constexpr const char* kFaults[] = {
    "none",
    "over-voltage",
    "under-voltage",
    "gate driver",
    "over-current",
    "power stage too hot",
    "motor too hot",
    "gate driver over-voltage",
    "gate driver under-voltage",
    "supply of the processor too low",
    "restarted by its watchdog",
    "encoder interface",
    "encoder signal too low",
    "encoder signal too high",
    "flash is corrupt",
    "offset of current sensor 1",
    "offset of current sensor 2",
    "offset of current sensor 3",
    "unbalanced currents",
    "brake",
    "resolver: loss of tracking",
    "resolver: degraded signal",
    "resolver: loss of signal",
};

}  // namespace

int least_length(std::uint32_t command) {
  for (const MessageAbout& message : kMessages) {
    if (message.command != command) continue;
    const Signal& last = message.signals.back();
    return last.byte + last.bytes;
  }
  return 0;
}

CanFrame set_frame(Command command, const Signal& signal, int node, double value) {
  CanFrame frame = {.id = id_of(command, node), .extended = true, .length = 4};
  write_signal(signal, kOrder, value, frame);
  return frame;
}

CanFrame question_frame(int own_id, int node, std::uint32_t mask) {
  CanFrame frame = {.id = id_of(kShortPacket, node), .extended = true, .length = kQuestionLength};
  write_signal(kSender, kOrder, own_id, frame);
  write_signal(kPacket, kOrder, kGetValuesSelective, frame);
  write_signal(kMask, kOrder, mask, frame);
  return frame;
}

std::optional<Answer> answer_from(const CanFrame& frame) {
  const auto number = [&](const Signal& s) {
    return static_cast<std::uint32_t>(read_signal(s, kOrder, frame));
  };
  const bool is_answer = frame.length == kAnswerLength && number(kWhat) == 1;
  if (!is_answer || number(kPacket) != kGetValuesSelective) return {};
  return Answer{static_cast<int>(number(kSender)), number(kMask),
                static_cast<std::uint8_t>(number(kValue))};
}

const char* words_of_fault(int code) {
  return code >= 0 && code < static_cast<int>(std::size(kFaults)) ? kFaults[code] : "unknown fault";
}

std::string dbc_text() {
  constexpr int kNodes[] = {1, 2, 3, 4, 5, 6, 7, 8};
  return hal::dbc_text({.prefix = "Vesc",
                        .comment = "VESC's own CAN protocol as Gannet uses it; ids 1 to 8.",
                        .order = kOrder,
                        .extended = true,
                        .id_of = id_of,
                        .messages = kMessages},
                       kNodes);
}

}  // namespace gannet::hal::vesc
