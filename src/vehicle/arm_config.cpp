#include "src/vehicle/arm_config.hpp"

namespace gannet::vehicle {

std::vector<JointConfig> pa10_joints() {
  struct Row {
    double alpha_deg, d_m, reach_deg, speed_deg_s, rest_deg;
  };
  // Rest: elbow and wrist bent, the flange level, far from every limit and singularity.
  static constexpr Row kRows[] = {{-90, 0.317, 177, 57, 0},  {90, 0, 90, 57, 45},
                                  {-90, 0.450, 174, 114, 0}, {90, 0, 137, 114, 90},
                                  {-90, 0.480, 255, 360, 0}, {90, 0, 165, 360, -45},
                                  {0, 0.070, 255, 360, 0}};
  std::vector<JointConfig> joints;
  for (const Row& row : kRows) {
    JointConfig joint;
    joint.alpha_deg = row.alpha_deg;
    joint.d_m = row.d_m;
    joint.min_deg = -row.reach_deg;
    joint.max_deg = row.reach_deg;
    joint.max_speed_deg_s = row.speed_deg_s;
    joint.max_acceleration_deg_s2 = 5 * row.speed_deg_s;
    joint.rest_deg = row.rest_deg;
    joints.push_back(joint);
  }
  return joints;
}

std::vector<JointConfig> joints_of(const ArmConfig& config) {
  return config.robot == "pa10" ? pa10_joints() : config.joints;
}

void describe(Visitor& v, JointConfig& c) {
  constexpr double kTurns = 3600;
  v.field("a_m", c.a_m,
          {.min = -10, .max = 10, .unit = "m", .help = "Length of the link: between the axes."});
  v.field("alpha_deg", c.alpha_deg,
          {.min = -180,
           .max = 180,
           .unit = "deg",
           .help = "Twist of the link: from this joint's axis to the next one's."});
  v.field("d_m", c.d_m,
          {.min = -10, .max = 10, .unit = "m", .help = "Offset of the link along the axis."});
  v.field("theta_deg", c.theta_deg,
          {.min = -360, .max = 360, .unit = "deg", .help = "Added to the joint's angle."});
  v.field("min_deg", c.min_deg,
          {.min = -kTurns, .max = kTurns, .unit = "deg", .help = "Least angle."});
  v.field("max_deg", c.max_deg,
          {.min = -kTurns, .max = kTurns, .unit = "deg", .help = "Greatest angle."});
  v.field("max_speed_deg_s", c.max_speed_deg_s,
          {.min = 0.01, .max = 3600, .unit = "deg/s", .help = "Fastest turn."});
  v.field("max_acceleration_deg_s2", c.max_acceleration_deg_s2,
          {.min = 0.1, .max = 1e6, .unit = "deg/s²", .help = "Fastest change of its speed."});
  v.field("gear_ratio", c.gear_ratio,
          {.min = 0.001,
           .max = 10000,
           .help = "Turns of the shaft that the drive speaks of for one of the joint; the drive's "
                   "own gear_ratio comes on top."});
  v.field("zero_deg", c.zero_deg,
          {.min = -kTurns,
           .max = kTurns,
           .unit = "deg",
           .help = "The joint's angle where the drive's position is 0."});
  v.field("rest_deg", c.rest_deg,
          {.min = -kTurns,
           .max = kTurns,
           .unit = "deg",
           .help = "Where the joint goes as far as the hand's motion leaves it free to."});
}

void describe(Visitor& v, ArmConfig& c) {
  v.field("robot", c.robot,
          {.choices = {"pa10", "custom"},
           .help = "Mitsubishi PA-10 with seven joints, or the joint tables below."});
  v.list("joint", c.joints,
         "One table for each joint from the base on, with robot = \"custom\": Denavit-Hartenberg "
         "with the frame at the end of its link.");
  v.field("body_position_m", c.body_position_m,
          {.min = -10,
           .max = 10,
           .size = 3,
           .unit = "m",
           .help = "Where the body's frame, which carries the cameras, sits on the last link."});
  v.field("body_turn_deg", c.body_turn_deg,
          {.min = -180,
           .max = 180,
           .size = 3,
           .unit = "deg",
           .help = "How it is turned there: R = Rz(yaw)·Ry(pitch)·Rx(roll), given as roll, pitch, "
                   "yaw."});
  v.field("radian_as_m", c.radian_as_m,
          {.min = 0.001,
           .max = 10,
           .unit = "m",
           .help = "A radian of turn counts as much as so many metres of way."});
  v.field(
      "singular_below_m", c.singular_below_m,
      {.min = 0,
       .max = 10,
       .unit = "m",
       .help = "Directions in which a radian of the joints moves the hand by less are damped."});
  v.field("damping_m", c.damping_m,
          {.min = 0.001, .max = 10, .unit = "m", .help = "The damping at the singularity itself."});
  v.field("posture_gain", c.posture_gain,
          {.min = 0,
           .max = 20,
           .unit = "1/s",
           .help = "How fast the null space pulls the joints towards rest_deg."});
  v.field("limit_margin_deg", c.limit_margin_deg,
          {.min = 0, .max = 90, .unit = "deg", .help = "Kept from each joint's limits of angle."});
  v.field(
      "feedback_age_s", c.feedback_age_s,
      {.min = 0.001, .max = 10, .unit = "s", .help = "Joint angles older than this move nothing."});
}

}  // namespace gannet::vehicle
