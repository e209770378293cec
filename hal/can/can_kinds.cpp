#include "hal/can/can_kinds.hpp"

#include "hal/can/local_bus.hpp"
#include "hal/can/memory_bus.hpp"
#include "hal/can/socketcan_bus.hpp"

namespace gannet::hal {
namespace {

using Made = Result<std::unique_ptr<CanBus>>;

Made make_local(const CanConfig& config, const std::vector<CanFilter>& wanted, int, TimePoint now) {
  auto bus = LocalBus::connect(config.path, now, wanted);
  if (!bus) return bus.error();
  return Made(std::move(*bus));
}

Made make_memory(const CanConfig&, const std::vector<CanFilter>&, int, TimePoint) {
  return make_lonely_bus();
}

Made make_socketcan(const CanConfig& config, const std::vector<CanFilter>& wanted, int most_waiting,
                    TimePoint now) {
  auto bus = SocketCanBus::open(config.interface, wanted, most_waiting, now);
  if (!bus) return bus.error();
  return Made(std::move(*bus));
}

struct Kind {
  const char* name;
  Made (*make)(const CanConfig&, const std::vector<CanFilter>&, int, TimePoint);
};
constexpr Kind kKinds[] = {
    {"local", make_local},
    {"memory", make_memory},
    {"socketcan", make_socketcan},
};

}  // namespace

Made make_can_bus(const CanConfig& config, const std::vector<CanFilter>& wanted, int most_waiting,
                  TimePoint now) {
  std::string known;
  for (const Kind& kind : kKinds) {
    if (config.kind == kind.name) return kind.make(config, wanted, most_waiting, now);
    known += std::string(known.empty() ? "" : ", ") + kind.name;
  }
  return Error{"can.kind '" + config.kind + "' is unknown; there are " + known};
}

}  // namespace gannet::hal
