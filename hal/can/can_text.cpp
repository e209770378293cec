#include "hal/can/can_text.hpp"

#include <charconv>
#include <cinttypes>
#include <cstdio>

namespace gannet::hal {
namespace {

constexpr std::uint32_t kErrorFlag = 0x20000000;  // CAN_ERR_FLAG of linux/can.h

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

Error refused(std::string_view text, std::string_view why) {
  constexpr std::size_t kShown = 60;  // a log may hold anything, the message stays one line
  std::string shown;
  for (char c : text.substr(0, kShown)) shown += (c >= ' ' && c <= '~') ? c : '?';
  if (text.size() > kShown) shown += "...";
  return Error{"CAN frame '" + shown + "': " + std::string(why)};
}

// nullptr: good; otherwise what is wrong.
const char* parse_id(std::string_view digits, CanFrame& frame) {
  if (digits.size() != 3 && digits.size() != 8) return "the id needs 3 or 8 hexadecimal digits";
  for (char c : digits) {
    if (hex_digit(c) < 0) return "the id has a character that is not hexadecimal";
    frame.id = frame.id << 4 | static_cast<std::uint32_t>(hex_digit(c));
  }
  if (digits.size() == 3) {
    return frame.id <= kMaxStandardId ? nullptr : "an 11-bit id is at most 7FF";
  }
  frame.error = (frame.id & kErrorFlag) != 0;
  frame.id &= ~kErrorFlag;
  frame.extended = !frame.error;
  return frame.id <= kMaxExtendedId ? nullptr : "a 29-bit id is at most 1FFFFFFF";
}

const char* parse_data(std::string_view digits, CanFrame& frame) {
  if (!digits.empty() && digits[0] == '#') return "CAN FD frames are not supported";
  if (!digits.empty() && (digits[0] == 'R' || digits[0] == 'r')) {
    return "remote frames are not supported";
  }
  while (!digits.empty()) {
    if (digits[0] == '.' && frame.length > 0) digits.remove_prefix(1);
    if (frame.length == frame.data.size()) return "more than 8 data bytes";
    if (digits.size() < 2) return "a data byte needs two hexadecimal digits";
    const int high = hex_digit(digits[0]), low = hex_digit(digits[1]);
    if (high < 0 || low < 0) return "the data has a character that is not hexadecimal";
    frame.data[frame.length++] = static_cast<std::uint8_t>(high * 16 + low);
    digits.remove_prefix(2);
  }
  return nullptr;
}

// The next word; words are separated by blanks.
std::string_view take_word(std::string_view& rest) {
  while (!rest.empty() && rest[0] == ' ') rest.remove_prefix(1);
  const std::string_view word = rest.substr(0, rest.find(' '));
  rest.remove_prefix(word.size());
  return word;
}

// "(seconds.microseconds)" with 1 … 9 digits after the point; further ones than 6 are cut.
bool parse_log_time(std::string_view word, std::int64_t& time_us) {
  if (word.size() < 5 || word.front() != '(' || word.back() != ')') return false;
  word = word.substr(1, word.size() - 2);
  const std::size_t point = word.find('.');
  if (point == std::string_view::npos || point == 0 || point > 12) return false;
  std::string fraction(word.substr(point + 1));
  if (fraction.empty() || fraction.size() > 9) return false;
  fraction.resize(6, '0');
  const std::string whole = std::string(word.substr(0, point)) + fraction;
  if (whole.find_first_not_of("0123456789") != std::string::npos) return false;
  return std::from_chars(whole.data(), whole.data() + whole.size(), time_us).ec == std::errc();
}

}  // namespace

std::string to_text(const CanFrame& frame) {
  char id[12];
  const std::uint32_t shown = frame.id | (frame.error ? kErrorFlag : 0);
  std::snprintf(id, sizeof id, frame.extended || frame.error ? "%08X#" : "%03X#", shown);
  std::string text = id;
  for (int i = 0; i < frame.length; ++i) {
    char byte[4];
    std::snprintf(byte, sizeof byte, "%02X", frame.data[static_cast<std::size_t>(i)]);
    text += byte;
  }
  return text;
}

Result<CanFrame> can_frame_from_text(std::string_view text) {
  const std::size_t hash = text.find('#');
  if (hash == std::string_view::npos) return refused(text, "no '#' between id and data");
  CanFrame frame;
  const char* why = parse_id(text.substr(0, hash), frame);
  if (why == nullptr) why = parse_data(text.substr(hash + 1), frame);
  if (why != nullptr) return refused(text, why);
  return frame;
}

std::string to_text(const CanLogLine& line) {
  char time[40];
  std::snprintf(time, sizeof time, "(%010" PRId64 ".%06" PRId64 ") ", line.time_us / 1000000,
                line.time_us % 1000000);
  return time + line.interface + " " + to_text(line.frame);
}

Result<CanLogLine> can_log_line_from_text(std::string_view text) {
  std::string_view rest = text;
  CanLogLine line;
  if (!parse_log_time(take_word(rest), line.time_us)) {
    return refused(text, "a log line begins with (seconds.microseconds)");
  }
  line.interface = take_word(rest);
  if (line.interface.empty()) return refused(text, "no interface after the time");
  const Result<CanFrame> frame = can_frame_from_text(take_word(rest));
  if (!frame) return frame.error();
  line.frame = *frame;
  const std::string_view direction = take_word(rest);  // candump -x adds R or T
  if (!direction.empty() && direction != "R" && direction != "T") {
    return refused(text, "something follows the frame");
  }
  if (!take_word(rest).empty()) return refused(text, "something follows the frame");
  return line;
}

}  // namespace gannet::hal
