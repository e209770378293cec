// What a line of /dev/gpiochipN can do, behind libgpiod: gpiod_calls_v1.cpp for its version 1
// (Debian 12), gpiod_calls_v2.cpp for version 2 (Debian 13); the Makefile takes the one that is
// installed. A seam as thin as that, so that tests can play the kernel. hold: start-up only; a
// held line is RT safe: neither version takes memory for levels and edges, and none of these calls
// waits for an edge.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "platform/base/result.hpp"
#include "platform/base/time.hpp"

namespace gannet::hal {

struct LineEdge {
  bool is_rising = false;
  TimePoint time = {};  // the kernel's, CLOCK_MONOTONIC
};

enum class Bias { kAsIs, kPullUp, kPullDown };

struct LineRequest {
  std::string chip;  // a path, a name or a label
  std::string line;  // a name or an offset
  Bias bias = Bias::kAsIs;
  bool is_output = false;
  bool high = false;  // the output's first level, without any other before it
};

class HeldLine {
 public:
  virtual ~HeldLine() = default;
  virtual int level() = 0;               // 0: low, 1: high, −errno
  virtual int set_level(bool high) = 0;  // 0 or −errno
  // Fills edges with the oldest ones that were not read yet; how many, or −errno.
  virtual int read_edges(std::span<LineEdge> edges) = 0;
};

class GpioCalls {
 public:
  virtual ~GpioCalls() = default;
  // An input reports both edges from now on. Error: which chip or line, why and what to do.
  virtual Result<std::unique_ptr<HeldLine>> hold(const LineRequest& request) = 0;
};

// The real ones; without state.
GpioCalls& linux_gpio_calls();

// For both versions: the error's words, and a text that is a number. −1: it is none.
Error line_error(const LineRequest& request, const char* what, int error_number);
int offset_from(const std::string& text);

}  // namespace gannet::hal
