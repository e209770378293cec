// CAN messages whose signals lie on whole bytes, described once: the drives' codecs, and the DBC
// files that let people's tools decode a log, are both made from this. Values; RT safe, dbc_text
// start-up only.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hal/can/can_frame.hpp"

namespace gannet::hal {

enum class Coding : std::uint8_t { kUnsigned, kSigned, kFloat };
enum class ByteOrder : std::uint8_t { kBigEndian, kLittleEndian };

struct Signal {
  const char* name;
  std::uint8_t byte;   // the first of it
  std::uint8_t bytes;  // 1, 2 or 4
  Coding coding;       // kFloat: IEEE 754, 4 bytes
  double scale;        // value = number on the wire × scale
  const char* unit;    // "" where it has none
};

struct MessageAbout {
  const char* name;
  std::uint32_t command;  // which message of a node; how it goes into the id, the protocol says
  std::uint8_t length;    // of data
  bool from_drive;
  std::span<const Signal> signals;
};

// A frame too short for the signal reads as if it went on with zeros; check the length before.
double read_signal(const Signal& signal, ByteOrder order, const CanFrame& frame);

// Rounds, and keeps to what the signal can hold; NaN is written as 0.
void write_signal(const Signal& signal, ByteOrder order, double value, CanFrame& frame);

struct DbcAbout {
  const char* prefix;  // of message and node names: "Vesc" gives Vesc1_Status
  const char* comment;
  ByteOrder order;
  bool extended;
  std::uint32_t (*id_of)(std::uint32_t command, int node);
  std::span<const MessageAbout> messages;
};

// A DBC file (Vector's database of CAN messages) with these nodes.
std::string dbc_text(const DbcAbout& about, std::span<const int> nodes);

}  // namespace gannet::hal
