#include "hal/drive/dronecan_names.hpp"

#include <cstdio>
#include <type_traits>

#include "hal/drive/dronecan_messages.hpp"

namespace gannet::hal::dronecan {
namespace {

// Has the calls of BitWriter and BitReader, and writes down what a message asks of them.
class BitLister {
 public:
  template <class Int>
  void field(const Int&, int bits) {
    add((std::is_signed_v<Int> ? "int" : "uint") + std::to_string(bits));
  }
  void half(const float&) { add("float16"); }

  template <class Items, class Each>
  void array(const Items& items, int count_bits, Each&& each) {
    if (count_bits > 0) add("uint" + std::to_string(count_bits));
    BitLister one;
    const std::remove_cvref_t<decltype(items[0])> item = {};
    each(one, item);
    add(one.text() + "[<=" + std::to_string(items.capacity()) + "]");
  }
  const std::string& text() const { return text_; }

 private:
  void add(const std::string& part) { text_ += (text_.empty() ? "" : ", ") + part; }
  std::string text_;
};

template <class Message>
std::string row(const char* kind) {
  const TypeFacts& type = Message::kType;
  char numbers[64];
  std::snprintf(numbers, sizeof numbers, "%d | `%016llX`", type.id,
                static_cast<unsigned long long>(type.signature));
  BitLister lister;
  const Message message;
  Message::describe_bits(message, lister);
  return "| `" + std::string(type.name) + "` | " + kind + " | " + numbers + " | " + lister.text() +
         " |\n";
}

}  // namespace

std::string reference_text() {
  return "# DroneCAN data types\n\n"
         "What Gannet says and understands (drive.kind = dronecan_esc), for decoding a log: name "
         "and signature as in the public DSDL, and the fields' types in their order on the wire. "
         "Made from the program's own description by `make docs`; do not edit.\n\n"
         "| data type | kind | id | signature | fields |\n|---|---|---|---|---|\n" +
         row<NodeStatus>("message") + row<RawCommand>("message") + row<EscStatus>("message") +
         row<ArmingStatus>("message") + row<Allocation>("message") + row<NodeInfo>("answer");
}

}  // namespace gannet::hal::dronecan
