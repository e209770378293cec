#include "hal/drive/odrive_messages.hpp"

namespace gannet::hal::odrive {
namespace {

struct Words {
  std::uint32_t bit;
  const char* text;
};
constexpr Words kErrors06[] = {
    {0x1, "still initialising"},
    {0x2, "system level"},
    {0x4, "timing"},
    {0x8, "missing estimate"},
    {0x10, "bad configuration"},
    {0x20, "gate driver"},
    {0x40, "missing input"},
    {0x100, "supply over-voltage"},
    {0x200, "supply under-voltage"},
    {0x400, "supply over-current"},
    {0x800, "supply regeneration over-current"},
    {0x1000, "current limit"},
    {0x2000, "motor too hot"},
    {0x4000, "inverter too hot"},
    {0x8000, "velocity limit"},
    {0x10000, "position limit"},
    {kWatchdog06, "watchdog expired"},
    {0x02000000, "emergency stop requested"},
    {0x04000000, "motor slips"},
    {0x08000000, "brake resistor disarmed"},
    {0x10000000, "thermistor disconnected"},
    {0x40000000, "calibration"},
};
constexpr Words kErrors05[] = {
    {0x1, "invalid state"},
    {0x40, "motor"},
    {0x80, "estimate without a sensor"},
    {0x100, "encoder"},
    {0x200, "controller"},
    {kWatchdog05, "watchdog expired"},
    {0x1000, "at the lower end stop"},
    {0x2000, "at the upper end stop"},
    {0x4000, "emergency stop requested"},
    {0x20000, "homing without an end stop"},
    {0x40000, "too hot"},
    {0x80000, "unknown position"},
};

const char* words(std::span<const Words> table, std::uint32_t error) {
  for (const Words& line : table) {
    if ((error & line.bit) != 0) return line.text;
  }
  return "unknown error";
}

}  // namespace

CanFrame frame_of(Command command, int node) {
  CanFrame frame = {.id = id_of(command, node)};
  for (const MessageAbout& message : kMessages) {
    if (message.command == command) frame.length = message.length;
  }
  return frame;
}

CanFrame state_frame(int node, AxisState state) {
  CanFrame frame = frame_of(kSetAxisState, node);
  write_signal(kRequestedState, kOrder, state, frame);
  return frame;
}

CanFrame mode_frame(int node, std::uint32_t input_mode) {
  CanFrame frame = frame_of(kSetControllerMode, node);
  write_signal(kModes[0], kOrder, kVelocityControl, frame);
  write_signal(kModes[1], kOrder, input_mode, frame);
  return frame;
}

CanFrame velocity_frame(int node, double turns_per_s) {
  CanFrame frame = frame_of(kSetInputVelocity, node);
  write_signal(kInputVelocity[0], kOrder, turns_per_s, frame);
  return frame;
}

const char* words_of_error(std::uint32_t error, bool is_firmware_05) {
  return is_firmware_05 ? words(kErrors05, error) : words(kErrors06, error);
}

std::string dbc_text() {
  constexpr int kNodes[] = {1, 2, 3, 4, 5, 6, 7, 8};
  return hal::dbc_text({.prefix = "Odrive",
                        .comment = "ODrive CANSimple as Gannet uses it; node ids 1 to 8.",
                        .order = kOrder,
                        .extended = false,
                        .id_of = id_of,
                        .messages = kMessages},
                       kNodes);
}

}  // namespace gannet::hal::odrive
