// RunFiles: the folder of one run: sockets, shared files, the rig, and the daemon's config that
// makes it live in this world. A temporary folder is removed at the end. Start-up only.
#pragma once

#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "src/config/daemon_config.hpp"
#include "src/world/scenario.hpp"

namespace gannet::world {

class RunFiles {
 public:
  // folder: "" for a new temporary one. Error: it cannot be made.
  static Result<RunFiles> create(const std::string& folder);
  RunFiles(RunFiles&& other) noexcept;
  RunFiles& operator=(RunFiles&&) = delete;
  ~RunFiles();

  const std::string& folder() const { return folder_; }
  std::string rig() const { return folder_ + "/rig.toml"; }
  std::string config() const { return folder_ + "/gannetd.toml"; }
  std::string log() const { return folder_ + "/gannetd.log"; }
  std::string frames() const { return folder_ + "/frames"; }
  std::string lines() const { return folder_ + "/lines"; }
  std::string bus() const { return folder_ + "/can"; }
  std::string step() const { return folder_ + "/step"; }
  std::string control() const { return folder_ + "/control"; }
  void keep() { temporary_ = false; }

 private:
  RunFiles(std::string folder, bool temporary)
      : folder_(std::move(folder)), temporary_(temporary) {}
  std::string folder_;
  bool temporary_;
};

// The config of a daemon in this world: devices by the run's files, vehicle by the plant.
config::DaemonConfig daemon_config(const Scenario& scenario, const RunFiles& files,
                                   const std::vector<std::string>& models, bool stepped);

// Writes rig and config.
Result<void> write_files(const Scenario& scenario, const RunFiles& files,
                         const config::DaemonConfig& config);

// Writes what the scenario sets, for a daemon that is not started with it: a drop-in of the config.
Result<void> write_settings(const Scenario& scenario, const RunFiles& files);

}  // namespace gannet::world
