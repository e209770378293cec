#include "src/control/protocol.hpp"

namespace gannet::control {
namespace {

// Text from outside may be no UTF-8: it is replaced, never thrown about.
std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

bool is_id(const Json& id) { return id.is_number_integer() || id.is_string(); }

}  // namespace

const char* to_string(ErrorCode code) {
  switch (code) {
    case ErrorCode::kBadJson:
      return "bad_json";
    case ErrorCode::kBadProtocol:
      return "bad_protocol";
    case ErrorCode::kBadRequest:
      return "bad_request";
    case ErrorCode::kUnknownMethod:
      return "unknown_method";
    case ErrorCode::kBadParams:
      return "bad_params";
    case ErrorCode::kRefused:
      return "refused";
    case ErrorCode::kBusy:
      return "busy";
  }
  return "?";
}

std::variant<Request, BadRequest> parse_request(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) {
    return BadRequest{nullptr, {ErrorCode::kBadJson, "the line is not one JSON object"}};
  }
  const Json id = json.contains("id") ? json["id"] : Json();
  const auto bad = [&](ErrorCode code, const std::string& text) {
    return BadRequest{is_id(id) ? id : Json(), {code, text}};
  };
  if (!json.contains("protocol") || json["protocol"] != kProtocol) {
    return bad(ErrorCode::kBadProtocol, "\"protocol\" must be 1");
  }
  if (!is_id(id)) return bad(ErrorCode::kBadRequest, "\"id\" must be a whole number or a text");
  if (!json.contains("method") || !json["method"].is_string()) {
    return bad(ErrorCode::kBadRequest, "\"method\" must be a text");
  }
  Request request{id, json["method"].get<std::string>()};
  if (json.contains("params")) request.params = json["params"];
  if (!request.params.is_object()) {
    return bad(ErrorCode::kBadRequest, "\"params\" must be an object");
  }
  for (const auto& [key, value] : json.items()) {
    if (key != "protocol" && key != "id" && key != "method" && key != "params") {
      return bad(ErrorCode::kBadRequest, "a request has no member \"" + key + "\"");
    }
  }
  return request;
}

std::string request_line(const Request& request) {
  Json json;
  json["protocol"] = kProtocol;
  json["id"] = request.id;
  json["method"] = request.method;
  if (!request.params.empty()) json["params"] = request.params;
  return dump(json);
}

std::string answer_line(const Json& id, const Answer& answer) {
  Json json;
  json["protocol"] = kProtocol;
  json["id"] = id;
  if (const auto* failure = std::get_if<Failure>(&answer)) {
    json["error"]["code"] = to_string(failure->code);
    if (!failure->reason.empty()) json["error"]["reason"] = failure->reason;
    json["error"]["text"] = failure->text;
  } else {
    json["result"] = std::get<Json>(answer);
  }
  return dump(json);
}

}  // namespace gannet::control
