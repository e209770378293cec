// Likeness: how sure it is that a photo-model is at a pose, rather than something that resembles
// it. For each channel of each eye −ln(1 − ρ²), ρ being the correlation of the smoothed image and
// the model there: what a sample of the image tells, in nats, about the model being at this place.
// Mean over S_in, and over S_in with S_out, and over the channels, each by the model's contrast in
// it; of the eye that sees less alike, since what one eye alone agrees with has no measured depth.
//
// The search's fitness (correlation_fitness.hpp) has floors on the contrast, for speed's seven bits
// and against faint noise; through murky water little contrast is left and they eat the true pose's
// score. Here the floor is the images' own rounding: the wrong poses of clear and of murky water
// end at the same likeness (docs/design/fitness.md; make bench, group "found or not"). RT safe.
#pragma once

#include "src/vision/point_set.hpp"
#include "src/vision/port_optics.hpp"
#include "src/vision/prepared_frame.hpp"

namespace gannet::vision {

// 0 (nothing alike, or less than half of the points in view) … 4. Level 0, metric points; the frame
// must be prepared about the target.
double likeness(const RigOptics& optics, const PointSet& points, const PreparedFrame& frame,
                const Transform<LeftCamera, Target>& pose);

}  // namespace gannet::vision
