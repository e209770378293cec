// The control protocol, version 1: one JSON object a line, both ways, over a Unix stream socket.
//   {"protocol": 1, "id": 7, "method": "goal", "params": {"mm": [0, 0, 500]}}
//   {"protocol": 1, "id": 7, "result": {…}}
//   {"protocol": 1, "id": 7, "error": {"code": "refused", "reason": "no_vehicle", "text": "…"}}
// id is any number or text; the answer carries it back. Methods: docs/reference/control.md.
// Control thread and tools.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "src/control/json.hpp"

namespace gannet::control {

inline constexpr int kProtocol = 1;
inline constexpr std::size_t kMaxLine = 64 * 1024;  // bytes of a request, without the newline

enum class ErrorCode {
  kBadJson,        // the line is no JSON object, or too long
  kBadProtocol,    // "protocol" is missing or not 1
  kBadRequest,     // id or method missing or of the wrong type
  kUnknownMethod,  // with the nearest known one in the text
  kBadParams,      // what and what is allowed, in the text
  kRefused,        // understood, but not now; "reason" is one word
  kBusy,           // too many requests wait
};
const char* to_string(ErrorCode code);  // "bad_json" …

struct Failure {
  ErrorCode code = ErrorCode::kBadRequest;
  std::string text;
  std::string reason = {};  // of kRefused
};

struct Request {
  Json id;
  std::string method;
  Json params = Json::object();
};

// A request, or the failure with the id as far as it could be read.
struct BadRequest {
  Json id;
  Failure failure;
};
std::variant<Request, BadRequest> parse_request(std::string_view line);

// What a method answers: a result or a failure.
using Answer = std::variant<Json, Failure>;

// Whole lines, with the newline.
std::string request_line(const Request& request);
std::string answer_line(const Json& id, const Answer& answer);

}  // namespace gannet::control
