#include "hal/drive/can_signals.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

namespace gannet::hal {
namespace {

std::size_t place(const Signal& signal, ByteOrder order, int significance) {
  const int offset =
      order == ByteOrder::kLittleEndian ? significance : signal.bytes - 1 - significance;
  return static_cast<std::size_t>(signal.byte + offset);
}

std::uint32_t raw_of(const Signal& signal, double value) {
  if (std::isnan(value)) return 0;
  if (signal.coding == Coding::kFloat) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(value / signal.scale));
  }
  const bool is_signed = signal.coding == Coding::kSigned;
  const double span = std::ldexp(1.0, 8 * signal.bytes);
  const double least = is_signed ? -span / 2 : 0, most = (is_signed ? span / 2 : span) - 1;
  const double number = std::clamp(std::nearbyint(value / signal.scale), least, most);
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(number));
}

std::string shortest(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string dbc_signal(const Signal& s, const DbcAbout& about, const std::string& receiver) {
  const bool is_big = about.order == ByteOrder::kBigEndian;
  // DBC names a big-endian signal by its highest bit, which is bit 7 of its first byte.
  const int start = 8 * s.byte + (is_big ? 7 : 0);
  return std::string(" SG_ ") + s.name + " : " + std::to_string(start) + "|" +
         std::to_string(8 * s.bytes) + "@" + (is_big ? "0" : "1") +
         (s.coding == Coding::kUnsigned ? "+" : "-") + " (" + shortest(s.scale) + ",0) [0|0] \"" +
         s.unit + "\" " + receiver + "\n";
}

}  // namespace

double read_signal(const Signal& signal, ByteOrder order, const CanFrame& frame) {
  std::uint32_t raw = 0;
  for (int i = 0; i < signal.bytes; ++i) {
    const std::size_t at = place(signal, order, i);
    if (at < frame.length) raw |= static_cast<std::uint32_t>(frame.data[at]) << 8 * i;
  }
  if (signal.coding == Coding::kFloat) return std::bit_cast<float>(raw) * signal.scale;
  if (signal.coding == Coding::kUnsigned) return raw * signal.scale;
  const int unused = 32 - 8 * signal.bytes;
  const auto number = static_cast<std::int32_t>(raw << unused) >> unused;
  return number * signal.scale;
}

void write_signal(const Signal& signal, ByteOrder order, double value, CanFrame& frame) {
  const std::uint32_t raw = raw_of(signal, value);
  for (int i = 0; i < signal.bytes; ++i) {
    frame.data[place(signal, order, i)] = static_cast<std::uint8_t>(raw >> 8 * i);
  }
}

std::string dbc_text(const DbcAbout& about, std::span<const int> nodes) {
  const auto name_of = [&](int node) { return about.prefix + std::to_string(node); };
  const auto id_of = [&](const MessageAbout& message, int node) {
    constexpr std::uint32_t kExtendedFlag = 0x80000000;
    return std::to_string(about.id_of(message.command, node) |
                          (about.extended ? kExtendedFlag : 0));
  };
  std::string text = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: Gannet";
  for (const int node : nodes) text += " " + name_of(node);
  text += "\n";
  std::string types;
  for (const int node : nodes) {
    for (const MessageAbout& message : about.messages) {
      text += "\nBO_ " + id_of(message, node) + " " + name_of(node) + "_" + message.name + ": " +
              std::to_string(message.length) + " " +
              (message.from_drive ? name_of(node) : "Gannet") + "\n";
      for (const Signal& signal : message.signals) {
        text += dbc_signal(signal, about, message.from_drive ? "Gannet" : name_of(node));
        if (signal.coding != Coding::kFloat) continue;
        types += "SIG_VALTYPE_ " + id_of(message, node) + " " + signal.name + " : 1;\n";
      }
    }
  }
  return text + "\nCM_ \"" + about.comment + "\";\n" + types;
}

}  // namespace gannet::hal
