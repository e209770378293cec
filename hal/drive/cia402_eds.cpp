#include <cstdio>

#include "hal/drive/cia402_objects.hpp"

namespace gannet::hal::cia402 {
namespace {

using Objects = std::vector<ObjectAbout>;

std::string digits(std::uint32_t value, int least) {
  char text[16];
  std::snprintf(text, sizeof text, "%0*X", least, value);
  return text;
}

std::string hex(std::uint32_t value, int least = 1) { return "0x" + digits(value, least); }

// Of a record or array, which has more than sub-index 0.
const char* group_name(std::uint16_t index) {
  switch (index) {
    case 0x1016:
      return "Consumer heartbeat time";
    case 0x1018:
      return "Identity object";
    case 0x1029:
      return "Error behavior";
    case 0x1200:
      return "SDO server parameter";
    case 0x60C2:
      return "Interpolation time period";
    default:
      break;
  }
  switch (index & 0xFF00) {
    case 0x1400:
      return "RPDO communication parameter";
    case 0x1600:
      return "RPDO mapping parameter";
    case 0x1800:
      return "TPDO communication parameter";
    default:
      return "TPDO mapping parameter";
  }
}

bool is_array(std::uint16_t index) { return index == 0x1016 || index == 0x1029; }

std::string start_text(const ObjectAbout& o) {
  if (o.adds_node_id) {
    return "$NODEID+" + hex(static_cast<std::uint32_t>(o.start));
  }
  const bool is_number = o.start < 0 || o.start < 10;
  return is_number ? std::to_string(o.start) : hex(static_cast<std::uint32_t>(o.start));
}

std::string access_text(const ObjectAbout& o) {
  if (o.access == Access::kConst) return "const";
  if (o.access == Access::kReadOnly) return "ro";
  if (o.in_rpdo == o.in_tpdo) return "rw";
  return o.in_rpdo ? "rww" : "rwr";
}

std::string entry(const ObjectAbout& o) {
  std::string text = "ParameterName=" + o.name +
                     "\nObjectType=0x7\nDataType=" + hex(static_cast<std::uint32_t>(o.type), 4) +
                     "\nAccessType=" + access_text(o) + "\nDefaultValue=" + start_text(o) +
                     "\nPDOMapping=" + (o.in_rpdo || o.in_tpdo ? "1" : "0") + "\n";
  if (o.min != o.max) {
    text += "LowLimit=" + std::to_string(o.min) + "\nHighLimit=" + std::to_string(o.max) + "\n";
  }
  return text;
}

int subs_of(const Objects& objects, std::uint16_t index) {
  int n = 0;
  for (const ObjectAbout& o : objects) n += o.id.index == index ? 1 : 0;
  return n;
}

template <class Belongs>
std::string list(const char* name, const Objects& objects, Belongs belongs) {
  std::string lines;
  int n = 0;
  for (const ObjectAbout& o : objects) {
    if (o.id.sub != 0 || !belongs(o.id.index)) continue;
    lines += std::to_string(++n) + "=" + hex(o.id.index, 4) + "\n";
  }
  return std::string("[") + name + "]\nSupportedObjects=" + std::to_string(n) + "\n" + lines + "\n";
}

std::string header() {
  return "[FileInfo]\n"
         "FileName=gannet-cia402.eds\n"
         "FileVersion=1\n"
         "FileRevision=1\n"
         "EDSVersion=4.0\n"
         "Description=A CiA 402 velocity drive, as Gannet commands and gannet-world simulates it\n"
         "CreationTime=12:00AM\n"
         "CreationDate=01-01-2026\n"
         "CreatedBy=gannet --reference\n"
         "ModificationTime=12:00AM\n"
         "ModificationDate=01-01-2026\n"
         "ModifiedBy=gannet --reference\n\n"
         "[DeviceInfo]\n"
         "VendorName=Gannet\n"
         "VendorNumber=0x0\n"
         "ProductName=Simulated CiA 402 drive\n"
         "ProductNumber=402\n"
         "RevisionNumber=1\n"
         "OrderCode=gannet-world\n"
         "BaudRate_10=0\nBaudRate_20=0\nBaudRate_50=0\nBaudRate_125=1\n"
         "BaudRate_250=1\nBaudRate_500=1\nBaudRate_800=1\nBaudRate_1000=1\n"
         "SimpleBootUpMaster=0\nSimpleBootUpSlave=1\n"
         "Granularity=8\nDynamicChannelsSupported=0\nGroupMessaging=0\n"
         "NrOfRXPDO=4\nNrOfTXPDO=4\nLSS_Supported=0\n\n"
         "[DummyUsage]\n"
         "Dummy0001=0\nDummy0002=0\nDummy0003=0\nDummy0004=0\n"
         "Dummy0005=0\nDummy0006=0\nDummy0007=0\n\n"
         "[Comments]\nLines=0\n\n";
}

}  // namespace

std::string eds_text() {
  const Objects objects = drive_objects();
  const auto is_mandatory = [](std::uint16_t i) {
    return i == 0x1000 || i == 0x1001 || i == 0x1018;
  };
  std::string text = header();
  text += list("MandatoryObjects", objects, is_mandatory);
  text += list("OptionalObjects", objects, [&](std::uint16_t i) { return !is_mandatory(i); });
  text += "[ManufacturerObjects]\nSupportedObjects=0\n";
  for (const ObjectAbout& o : objects) {
    const std::string index = digits(o.id.index, 4);
    const int subs = subs_of(objects, o.id.index);
    if (subs > 1 && o.id.sub == 0) {
      text += "\n[" + index + "]\nParameterName=" + group_name(o.id.index) +
              "\nObjectType=" + (is_array(o.id.index) ? "0x8" : "0x9") +
              "\nSubNumber=" + std::to_string(subs) + "\n";
    }
    text += "\n[" + index + (subs > 1 ? "sub" + digits(o.id.sub, 1) : "") + "]\n" + entry(o);
  }
  return text;
}

}  // namespace gannet::hal::cia402
