// What a document must keep to as a whole, whether or not anything of it is shown.
#pragma once

#include "scene/gltf/accessor.h"
#include "scene/gltf/nodes.h"

namespace wavelobe::gltf {

// Extensions must be objects and stand where they mean something; lists of extensions name each once. Those that the file uses and
// does not declare are a warning.
void check_extension_objects(Document& document);

// Primitives must have attributes of known names, bounds for their positions, and the coordinates that their materials look up.
void check_primitives(Document& document, const Accessors& accessors);

// Joints must be below one root, shown with what follows them, and there for each vertex that names them.
void check_skins(Document& document, const Accessors& accessors, const NodeTree& tree);

}  // namespace wavelobe::gltf
