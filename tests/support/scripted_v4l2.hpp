// ScriptedV4l2: V4L2 devices that are played instead of driven, in a time of their own that runs
// only while somebody waits in poll(). A device gives a frame each period, filled with its number
// + 1; what a test changes of it (`alter`), refuses or unplugs is what its user must survive.
// Any thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "hal/camera/v4l2_system.hpp"
#include "tests/support/heap_calls.hpp"

namespace gannet::test {

class ScriptedV4l2 final : public hal::V4l2System {
 public:
  struct Mode {
    std::uint32_t fourcc = V4L2_PIX_FMT_YUYV;
    int width = 16, height = 4;
    std::vector<int> rates_hz = {50, 25};
  };
  struct Control {
    std::uint32_t id;
    std::uint32_t type;
    const char* name;
    int min, max, value;
    std::vector<const char*> menu = {};
    std::function<int(int)> keep = nullptr;  // what the driver makes of a value
    int refuse = 0;                          // with this error
  };
  struct Frame {
    TimePoint stamp;
    std::uint32_t sequence = 0;
    std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    int bytes = -1;                     // −1: a whole image
    std::uint8_t fill = 0;              // of the image
    std::vector<std::uint8_t> content;  // or this
  };
  struct Device {
    std::uint32_t abilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
    std::vector<Mode> modes = {{}};
    std::vector<Control> controls;
    int most_buffers = 32;
    int padding = 0;  // bytes behind each row
    std::uint32_t colourspace = V4L2_COLORSPACE_SRGB;
    bool rate_can_be_set = true;
    std::uint32_t clock = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    Duration period = std::chrono::milliseconds(20);
    Duration latency = std::chrono::milliseconds(1);  // from stamp to there
    // False: the frame never comes. Its number is used.
    std::function<bool(Frame&)> alter;

    bool plugged = true;
    bool stream_fails = false;    // POLLERR and EIO until it is started anew
    int queue_errors = 0;         // so many QBUF are refused
    int start_error = 0;          // of STREAMON
    bool loops_back = false;      // as v4l2loopback: writes round and round, whoever holds a buffer
    std::atomic<int> opened = 0;  // how often; by whichever thread

   private:
    friend class ScriptedV4l2;
    struct Memory {
      std::vector<std::uint8_t> bytes;
      bool queued = false;
    };
    int fd = -1;
    v4l2_pix_format format = {};
    v4l2_fract interval = {1, 50};
    std::vector<std::unique_ptr<Memory>> memory;
    std::deque<int> waiting;  // queued buffers
    std::deque<v4l2_buffer> done;
    bool streaming = false;
    bool gone = false;  // unplugged while open
    TimePoint next = {};
    std::uint32_t sequence = 0;
  };

  explicit ScriptedV4l2(TimePoint start = time_from_ns(100'000'000'000)) : now_(start) {}

  Device& add(const std::string& path) { return devices_[path]; }
  // Between two calls of the user; also while its opener thread runs.
  template <class Change>
  void change(Change&& change) {
    const std::lock_guard lock(mutex_);
    change();
  }
  void unplug(Device& device) {
    change([&] { device.plugged = false, device.gone = true; });
  }
  void plug(Device& device) {
    change([&] { device.plugged = true; });
  }
  int mapped() const { return mapped_; }  // buffers that are mapped now
  int queued(const Device& device) const { return static_cast<int>(device.waiting.size()); }

  // What all this took of the heap, of the calling thread's.
  static std::uint64_t heap_calls() { return own_heap_; }

  // ---- V4l2System
  int open(const std::string& path) override {
    const std::lock_guard lock(mutex_);
    const auto found = devices_.find(path);
    if (found == devices_.end() || !found->second.plugged) return -ENOENT;
    Device& device = found->second;
    if (device.fd >= 0) return -EBUSY;
    ++device.opened;
    device.gone = false;
    return device.fd = next_fd_++;
  }
  void close(int fd) override {
    const std::lock_guard lock(mutex_);
    Device* const device = of(fd);
    if (device == nullptr) return;
    stop(*device);
    device->fd = -1;
    for (auto& memory : device->memory) graveyard_.push_back(std::move(memory));
    device->memory.clear();
  }
  int ioctl(int fd, unsigned long request, void* argument) override {
    const OwnHeap own;
    const std::lock_guard lock(mutex_);
    Device* const device = of(fd);
    if (device == nullptr) return -EBADF;
    if (device->gone) return -ENODEV;
    deliver_due();
    return serve(*device, request, argument);
  }
  void* map(int fd, std::size_t bytes, std::int64_t offset) override {
    const std::lock_guard lock(mutex_);
    Device* const device = of(fd);
    const auto index = static_cast<std::size_t>(offset / kOffset);
    if (device == nullptr || index >= device->memory.size()) return nullptr;
    if (bytes != device->memory[index]->bytes.size()) return nullptr;
    ++mapped_;
    return device->memory[index]->bytes.data();
  }
  void unmap(void*, std::size_t) override {
    const std::lock_guard lock(mutex_);
    --mapped_;
  }
  TimePoint now() const override {
    const std::lock_guard lock(mutex_);
    return now_;
  }
  int poll(std::span<pollfd> fds, TimePoint until) override {
    const OwnHeap own;
    for (;;) {
      if (const int ready = look(fds); ready > 0) return ready;
      // Descriptors of the kernel belong to threads that work in real time.
      std::vector<pollfd> real;
      for (const pollfd& one : fds)
        if (one.fd >= 0 && one.fd < kFirstFd) real.push_back(one);
      if (!real.empty() && ::poll(real.data(), real.size(), 2) > 0) return look(fds);
      const std::lock_guard lock(mutex_);
      if (now_ >= until) return 0;
      TimePoint next = until;
      for (auto& [path, device] : devices_)
        if (device.streaming && !device.gone) next = std::min(next, device.next + device.latency);
      now_ = std::max(now_, next);
    }
  }

 private:
  static inline thread_local std::uint64_t own_heap_ = 0;
  struct OwnHeap {
    const std::uint64_t before = test::heap_calls;
    ~OwnHeap() { own_heap_ += test::heap_calls - before; }
  };
  static constexpr int kFirstFd = 1'000'000;
  static constexpr std::int64_t kOffset = 4096;

  Device* of(int fd) {
    for (auto& [path, device] : devices_)
      if (device.fd == fd) return &device;
    return nullptr;
  }

  int look(std::span<pollfd> fds) {
    int ready = 0;
    for (pollfd& one : fds) {
      one.revents = 0;
      if (one.fd >= 0 && one.fd < kFirstFd) {
        ::poll(&one, 1, 0);
      } else if (one.fd >= 0) {
        const std::lock_guard lock(mutex_);
        deliver_due();
        const Device* const device = of(one.fd);
        if (device == nullptr)
          one.revents = POLLNVAL;
        else if (device->gone)
          one.revents = POLLERR | POLLHUP;
        else if (!device->streaming || device->stream_fails)
          one.revents = POLLERR;
        else if (!device->done.empty())
          one.revents = POLLIN;
      }
      ready += one.revents != 0 ? 1 : 0;
    }
    return ready;
  }

  void stop(Device& device) {
    device.streaming = false;
    device.stream_fails = false;
    device.waiting.clear();
    device.done.clear();
    for (auto& memory : device.memory) memory->queued = false;
  }

  void deliver_due() {
    for (auto& [path, device] : devices_)
      while (device.streaming && !device.gone && device.next + device.latency <= now_)
        deliver(device);
  }

  void deliver(Device& device) {
    Frame frame;
    frame.stamp = device.next;
    frame.sequence = device.sequence++;
    frame.flags = device.clock;
    frame.fill = static_cast<std::uint8_t>(frame.sequence + 1);
    device.next += device.period;
    if (!device.alter || device.alter(frame)) give(device, frame);
  }

  // At the start of a stream, as v4l2loopback: what lay in the buffer, with a new stamp.
  void give_stale(Device& device) {
    Frame frame;
    frame.stamp = now_;
    frame.flags = device.clock;
    frame.fill = 0xee;
    give(device, frame);
  }

  void give(Device& device, const Frame& frame) {
    if (device.waiting.empty() && !device.loops_back) return;
    int index = static_cast<int>(frame.sequence % device.memory.size());
    if (!device.loops_back) {
      index = device.waiting.front();
      device.waiting.pop_front();
    }
    auto& bytes = device.memory[static_cast<std::size_t>(index)]->bytes;
    std::memset(bytes.data(), frame.fill, bytes.size());
    std::copy_n(frame.content.begin(), std::min(frame.content.size(), bytes.size()), bytes.begin());
    v4l2_buffer buffer = {};
    buffer.index = static_cast<std::uint32_t>(index);
    buffer.bytesused =
        static_cast<std::uint32_t>(frame.bytes >= 0        ? static_cast<std::size_t>(frame.bytes)
                                   : frame.content.empty() ? bytes.size()
                                                           : frame.content.size());
    buffer.flags = frame.flags;
    buffer.sequence = frame.sequence;
    buffer.timestamp.tv_sec = to_ns(frame.stamp) / 1'000'000'000;
    buffer.timestamp.tv_usec = to_ns(frame.stamp) % 1'000'000'000 / 1000;
    device.done.push_back(buffer);
  }

  template <class T>
  static T& as(void* argument) {
    return *static_cast<T*>(argument);
  }

  int serve(Device& d, unsigned long request, void* argument) {
    switch (request) {
      case VIDIOC_QUERYCAP:
        return query(d, as<v4l2_capability>(argument));
      case VIDIOC_ENUM_FMT:
        return enumerate(d, as<v4l2_fmtdesc>(argument));
      case VIDIOC_ENUM_FRAMESIZES:
        return enumerate(d, as<v4l2_frmsizeenum>(argument));
      case VIDIOC_ENUM_FRAMEINTERVALS:
        return enumerate(d, as<v4l2_frmivalenum>(argument));
      case VIDIOC_S_FMT:
        return set(d, as<v4l2_format>(argument));
      case VIDIOC_G_PARM:
      case VIDIOC_S_PARM:
        return parameters(d, request, as<v4l2_streamparm>(argument));
      case VIDIOC_QUERYCTRL:
        return query(d, as<v4l2_queryctrl>(argument));
      case VIDIOC_QUERYMENU:
        return query(d, as<v4l2_querymenu>(argument));
      case VIDIOC_G_CTRL:
      case VIDIOC_S_CTRL:
        return control(d, request, as<v4l2_control>(argument));
      case VIDIOC_REQBUFS:
        return make_buffers(d, as<v4l2_requestbuffers>(argument));
      case VIDIOC_QUERYBUF:
        return query(d, as<v4l2_buffer>(argument));
      case VIDIOC_QBUF:
        return queue(d, as<v4l2_buffer>(argument));
      case VIDIOC_DQBUF:
        return dequeue(d, as<v4l2_buffer>(argument));
      case VIDIOC_STREAMON:
        if (d.start_error != 0) return d.start_error;
        d.streaming = true;
        give_stale(d);
        d.sequence = 0;
        d.next = now_ + d.period;
        return 0;
      case VIDIOC_STREAMOFF:
        stop(d);
        return 0;
    }
    return -ENOTTY;
  }

  // 32 bytes are the least that the kernel's names have; some of its structs are packed.
  static void write(__u8* to, const char* text, std::size_t room = 32) {
    std::memcpy(to, text, std::min(room - 1, std::strlen(text)));
  }
  int query(Device& d, v4l2_capability& c) {
    write(c.driver, "scripted", 16), write(c.card, "Scripted camera"), write(c.bus_info, "bus:1");
    c.capabilities = d.abilities | V4L2_CAP_DEVICE_CAPS;
    c.device_caps = d.abilities;
    return 0;
  }
  static std::vector<std::uint32_t> formats(const Device& d) {
    std::vector<std::uint32_t> list;
    for (const Mode& mode : d.modes)
      if (std::find(list.begin(), list.end(), mode.fourcc) == list.end())
        list.push_back(mode.fourcc);
    return list;
  }
  static std::vector<const Mode*> modes(const Device& d, std::uint32_t fourcc) {
    std::vector<const Mode*> list;
    for (const Mode& mode : d.modes)
      if (mode.fourcc == fourcc) list.push_back(&mode);
    return list;
  }
  static int enumerate(const Device& d, v4l2_fmtdesc& q) {
    const auto list = formats(d);
    if (q.index >= list.size()) return -EINVAL;
    q.pixelformat = list[q.index];
    write(q.description, "what the driver calls it");
    return 0;
  }
  static int enumerate(const Device& d, v4l2_frmsizeenum& q) {
    const auto list = modes(d, q.pixel_format);
    if (q.index >= list.size()) return -EINVAL;
    q.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    q.discrete.width = static_cast<std::uint32_t>(list[q.index]->width);
    q.discrete.height = static_cast<std::uint32_t>(list[q.index]->height);
    return 0;
  }
  static int enumerate(const Device& d, v4l2_frmivalenum& q) {
    for (const Mode* mode : modes(d, q.pixel_format)) {
      if (mode->width != static_cast<int>(q.width) || q.index >= mode->rates_hz.size()) continue;
      q.type = V4L2_FRMIVAL_TYPE_DISCRETE;
      q.discrete = {1, static_cast<std::uint32_t>(mode->rates_hz[q.index])};
      return 0;
    }
    return -EINVAL;
  }
  static int bytes_per_pixel_row(std::uint32_t fourcc, int width) {
    return fourcc == V4L2_PIX_FMT_NV12 ? width : 2 * width;
  }
  // As drivers do: never refused, the nearest that there is instead.
  int set(Device& d, v4l2_format& f) {
    if (d.streaming) return -EBUSY;
    const Mode* best = nullptr;
    for (const Mode& mode : d.modes) {
      const auto far = [&](const Mode& m) {
        return (m.fourcc == f.fmt.pix.pixelformat ? 0 : 1'000'000) +
               std::abs(m.width - static_cast<int>(f.fmt.pix.width)) +
               std::abs(m.height - static_cast<int>(f.fmt.pix.height));
      };
      if (best == nullptr || far(mode) < far(*best)) best = &mode;
    }
    if (best == nullptr) return -EINVAL;
    auto& pix = d.format;
    pix = {};
    pix.width = static_cast<std::uint32_t>(best->width);
    pix.height = static_cast<std::uint32_t>(best->height);
    pix.pixelformat = best->fourcc;
    const int stride = bytes_per_pixel_row(best->fourcc, best->width) + d.padding;
    pix.bytesperline = best->fourcc == V4L2_PIX_FMT_MJPEG ? 0 : static_cast<std::uint32_t>(stride);
    const int rows = best->fourcc == V4L2_PIX_FMT_NV12 ? best->height * 3 / 2 : best->height;
    pix.sizeimage = static_cast<std::uint32_t>(stride * rows);
    pix.colorspace = d.colourspace;
    d.interval = {1, static_cast<std::uint32_t>(best->rates_hz.front())};
    f.fmt.pix = pix;
    return 0;
  }
  static int parameters(Device& d, unsigned long request, v4l2_streamparm& p) {
    auto& capture = p.parm.capture;
    if (request == VIDIOC_S_PARM && d.rate_can_be_set) {
      const int asked =
          static_cast<int>((capture.timeperframe.denominator + capture.timeperframe.numerator / 2) /
                           std::max(1u, capture.timeperframe.numerator));
      for (const Mode* mode : modes(d, d.format.pixelformat))
        for (const int rate : mode->rates_hz)
          if (mode->width == static_cast<int>(d.format.width) && rate == asked)
            d.interval = {1, static_cast<std::uint32_t>(rate)};
    }
    capture = {};
    capture.capability = d.rate_can_be_set && !d.loops_back ? V4L2_CAP_TIMEPERFRAME : 0;
    capture.timeperframe = d.interval;
    return 0;
  }
  static Control* find(Device& d, std::uint32_t id) {
    for (Control& c : d.controls)
      if (c.id == id) return &c;
    return nullptr;
  }
  static int query(Device& d, v4l2_queryctrl& q) {
    const Control* best = nullptr;
    const std::uint32_t after = q.id & ~V4L2_CTRL_FLAG_NEXT_CTRL;
    for (const Control& c : d.controls)
      if (c.id > after && (best == nullptr || c.id < best->id)) best = &c;
    if (best == nullptr) return -EINVAL;
    q.id = best->id;
    q.type = best->type;
    write(q.name, best->name);
    q.minimum = best->min, q.maximum = best->max, q.step = 1, q.default_value = best->min;
    q.flags = 0;
    return 0;
  }
  static int query(Device& d, v4l2_querymenu& q) {
    const Control* const c = find(d, q.id);
    if (c == nullptr || q.index >= c->menu.size() || c->menu[q.index] == nullptr) return -EINVAL;
    write(q.name, c->menu[q.index]);
    return 0;
  }
  static int control(Device& d, unsigned long request, v4l2_control& v) {
    Control* const c = find(d, v.id);
    if (c == nullptr) return -EINVAL;
    if (request == VIDIOC_S_CTRL) {
      if (c->refuse != 0) return c->refuse;
      c->value = c->keep ? c->keep(v.value) : v.value;
    }
    v.value = c->value;
    return 0;
  }
  int make_buffers(Device& d, v4l2_requestbuffers& r) {
    r.count = std::min(r.count, static_cast<std::uint32_t>(d.most_buffers));
    for (std::uint32_t i = 0; i < r.count; ++i) {
      d.memory.push_back(std::make_unique<Device::Memory>());
      d.memory.back()->bytes.resize(d.format.sizeimage);
    }
    return 0;
  }
  static int query(Device& d, v4l2_buffer& b) {
    if (b.index >= d.memory.size()) return -EINVAL;
    b.length = static_cast<std::uint32_t>(d.memory[b.index]->bytes.size());
    b.m.offset = b.index * static_cast<std::uint32_t>(kOffset);
    b.flags = V4L2_BUF_FLAG_MAPPED | d.clock;
    return 0;
  }
  static int queue(Device& d, v4l2_buffer& b) {
    if (d.queue_errors > 0) return --d.queue_errors, -EINVAL;
    if (b.index >= d.memory.size()) return -EINVAL;
    if (d.loops_back) return 0;
    if (d.memory[b.index]->queued) return -EINVAL;
    d.memory[b.index]->queued = true;
    d.waiting.push_back(static_cast<int>(b.index));
    return 0;
  }
  static int dequeue(Device& d, v4l2_buffer& b) {
    if (d.stream_fails) return -EIO;
    if (!d.streaming) return -EINVAL;
    if (d.done.empty()) return -EAGAIN;
    b = d.done.front();
    d.done.pop_front();
    if (b.index < d.memory.size()) d.memory[b.index]->queued = false;
    return 0;
  }

  mutable std::mutex mutex_;
  TimePoint now_;
  std::map<std::string, Device> devices_;
  std::vector<std::unique_ptr<Device::Memory>> graveyard_;  // mapped memory outlives its device
  int next_fd_ = kFirstFd;
  int mapped_ = 0;
};

}  // namespace gannet::test
