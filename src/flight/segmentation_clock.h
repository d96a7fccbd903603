#pragma once

namespace flightwatt::flight {

/// The segmentation looks at a flight so often [s], from its first sample of power on (without power: of altitude).
inline constexpr double segmentation_step_s = 0.5;

}  // namespace flightwatt::flight
