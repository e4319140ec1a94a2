// The channels of a picture beside its colours, as kernels record them.
#pragma once

#include "render/flatten.h"

namespace wavelobe {

// Which layers and moments the scene's channels are made of, and the numbers that layers give its shapes: from 1 on in the order
// of the scene, instances after all others. Those within instances have none.
void flatten_layers(const Scene& scene, DeviceScene& out);

}  // namespace wavelobe
