#include "src/vehicle/rov.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::vehicle {
namespace {

Vector6d stacked(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Vector6d out;
  out << a, b;
  return out;
}

Wrench<Body> wrench_of(const Vector6d& v) { return {v.head<3>(), v.tail<3>()}; }

Result<Allocation::Axes> axes_of(const std::vector<std::string>& names) {
  static constexpr const char* kAxes[6] = {"x", "y", "z", "roll", "pitch", "yaw"};
  Allocation::Axes axes = {};
  for (const std::string& name : names) {
    const auto* found = std::find(std::begin(kAxes), std::end(kAxes), name);
    if (found == std::end(kAxes)) {
      return Error{"vehicle.rov.controlled: unknown axis '" + name +
                   "'; known: x, y, z, roll, pitch, yaw"};
    }
    axes[static_cast<std::size_t>(found - kAxes)] = true;
  }
  if (names.empty()) return Error{"vehicle.rov.controlled: no axis is named"};
  return axes;
}

Result<void> check(const RovConfig& c) {
  if (c.inertia_kg_m2.size() != 3) return Error{"vehicle.rov.inertia_kg_m2 needs three numbers"};
  for (const auto* list : {&c.added_mass, &c.linear_drag, &c.quadratic_drag}) {
    if (list->size() != 6) {
      return Error{"vehicle.rov: added_mass, linear_drag and quadratic_drag need six numbers each"};
    }
  }
  if (!(c.mass_kg > 0)) return Error{"vehicle.rov.mass_kg must be positive"};
  return {};
}

}  // namespace

Result<std::unique_ptr<Vehicle>> Rov::create(const RovConfig& config) {
  if (const auto checked = check(config); !checked) return checked.error();
  const auto axes = axes_of(config.controlled);
  if (!axes) return axes.error();
  const auto thrusters = thrusters_of(config);
  if (!thrusters) return thrusters.error();
  const auto allocation = Allocation::create(*thrusters, *axes);
  if (!allocation) return allocation.error();
  std::vector<CurveConfig> curves;
  for (const auto& thruster : *thrusters) curves.push_back(thruster.curve);
  return std::unique_ptr<Vehicle>(new Rov(config, *allocation, *axes, std::move(curves)));
}

Rov::Rov(const RovConfig& c, const Allocation& allocation, const Allocation::Axes& controlled,
         std::vector<CurveConfig> curves)
    : allocation_(allocation), curves_(std::move(curves)) {
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    controlled_[i] = controlled[k] ? 1 : 0;
    plant_.mass[i] = c.added_mass[k] + (i < 3 ? c.mass_kg : c.inertia_kg_m2[k - 3]);
    plant_.linear_drag[i] = c.linear_drag[k];
    plant_.quadratic_drag[i] = c.quadratic_drag[k];
    gains_.proportional[i] = i < 3 ? c.velocity_gain : c.rate_gain;
    gains_.integral[i] = i < 3 ? c.velocity_integral : c.rate_integral;
  }
  plant_.steady = stacked({0, 0, c.net_buoyancy_n}, Eigen::Vector3d::Zero());
  plant_.lag_s = c.thruster_lag_s;
  gains_.slew_n_s = c.slew_n_s;
  gains_.smoothing_s = c.acceleration_smoothing_s;
  thrusts_.setZero(allocation_.size());
  rotors_.setZero(allocation_.size());
}

Vector6d Rov::drag(const Vector6d& v) const {
  return (plant_.linear_drag.array() + plant_.quadratic_drag.array() * v.array().abs()) * v.array();
}

Vector6d Rov::error_of(const MotionWish& wish, const Vector6d& velocity) const {
  const Vector6d own =
      wish.measured_valid ? stacked(wish.measured.linear, wish.measured.angular) : model_velocity_;
  return (velocity - own).cwiseProduct(controlled_);
}

// The wish's derivative by a first-order filter: the wish jumps a little with every image. A hold
// stops at once and has none.
Vector6d Rov::acceleration(const Vector6d& velocity, Permit permit, double seconds) {
  if (permit != Permit::kFull || gains_.smoothing_s <= 0) {
    smooth_ = velocity;
    return Vector6d::Zero();
  }
  smooth_ += std::min(seconds / gains_.smoothing_s, 1.0) * (velocity - smooth_);
  return (velocity - smooth_) / gains_.smoothing_s;
}

// All thrusts go the same share of their way, so that what is reached lies on the way from the old
// wrench to the new one, within every limit.
void Rov::slew(const Allocation::Thrusts& wanted, double seconds) {
  const double largest = (wanted - thrusts_).cwiseAbs().maxCoeff();
  const double most = gains_.slew_n_s * seconds;
  const double part = largest > most ? most / largest : 1;
  thrusts_ += part * (wanted - thrusts_);
}

// Conditional integration: an axis of which the motors leave something undone does not ask for more
// of it. Back-calculation was refused: where the proportional part alone saturates, which a far
// target makes it do, it drives the integral far to the other side.
void Rov::integrate(const Vector6d& error, const Vector6d& undone, double seconds) {
  for (int i = 0; i < 6; ++i) {
    const double change = seconds * plant_.mass[i] * gains_.integral[i] * error[i];
    if (std::abs(undone[i]) < 1e-6 || change * undone[i] < 0) integral_[i] += change;
  }
}

// The lag is one of the rotor's speed, whose square the thrust is: near rest it answers late, and
// most of all where it reverses. Drag is taken implicitly: stable for every step.
void Rov::advance_model(double seconds) {
  const double part = plant_.lag_s > 0 ? 1 - std::exp(-seconds / plant_.lag_s) : 1;
  for (int i = 0; i < allocation_.size(); ++i) {
    const double wanted = std::copysign(std::sqrt(std::abs(thrusts_[i])), thrusts_[i]);
    rotors_[i] += part * (wanted - rotors_[i]);
  }
  const Vector6d wrench = allocation_.wrench(rotors_.cwiseProduct(rotors_.cwiseAbs()));
  for (int i = 0; i < 6; ++i) {
    const double v = model_velocity_[i];
    const double damping = plant_.linear_drag[i] + plant_.quadratic_drag[i] * std::abs(v);
    const double force = wrench[i] + (stopped_ ? 0 : controlled_[i] * plant_.steady[i]);
    model_velocity_[i] =
        (plant_.mass[i] * v + seconds * force) / (plant_.mass[i] + seconds * damping);
  }
}

void Rov::stop(std::span<hal::DriveSetpoint> setpoints, double seconds) {
  for (auto& setpoint : setpoints) setpoint.value = 0;
  thrusts_.setZero();
  integral_.setZero();
  smooth_.setZero();
  // A vehicle without thrust drifts as it likes; nothing is claimed of its buoyancy then.
  stopped_ = true;
  advance_model(seconds);
}

Reach Rov::update(const MotionWish& wish, Permit permit, Duration dt,
                  std::span<hal::DriveSetpoint> setpoints) {
  Reach reach;
  const double seconds = std::clamp(to_seconds(dt), 0.0, 0.1);
  if (permit == Permit::kNone || setpoints.size() < curves_.size()) {
    stop(setpoints, seconds);
    return reach;
  }
  Vector6d velocity = Vector6d::Zero();
  if (permit == Permit::kFull) velocity = stacked(wish.velocity.linear, wish.velocity.angular);
  const Vector6d error = error_of(wish, velocity);
  const Vector6d push = plant_.mass.cwiseProduct(gains_.proportional.cwiseProduct(error) +
                                                 acceleration(velocity, permit, seconds));
  Vector6d wished = push + integral_ + drag(velocity) - plant_.steady;
  wished = wished.cwiseProduct(controlled_);
  if (!wished.allFinite()) {
    stop(setpoints, seconds);
    return reach;
  }

  const Allocation::Share share = allocation_.share(wished);
  slew(share.thrusts, seconds);
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    setpoints[i].value = command_for(curves_[i], thrusts_[static_cast<int>(i)]);
  }
  const Vector6d reached = allocation_.wrench(thrusts_);
  if (wish.measured_valid) integrate(error, wished - reached, seconds);
  stopped_ = false;
  advance_model(seconds);
  reach.wished = wrench_of(wished);
  reach.reached = wrench_of(reached);
  reach.unreachable = wrench_of(share.unreachable);
  reach.scale = share.scale;
  return reach;
}

Twist<Body> Rov::own_velocity() const {
  return {model_velocity_.head<3>(), model_velocity_.tail<3>()};
}

void Rov::reset() {
  integral_.setZero();
  smooth_.setZero();
  rotors_.setZero();
  model_velocity_.setZero();
}

}  // namespace gannet::vehicle
