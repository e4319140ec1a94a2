// Shape groups, the instances that place them, and shapes put together.
#include "scene/mitsuba/query.h"

namespace wavelobe::mitsuba {

namespace {

// What a group may not hold; false with the fault on record.
bool may_be_instanced(Context& context, const Child& child) {
    const Object& object = *child.object;
    if (object.type == "instance" || object.type == "shapegroup") {
        context.faults.add(child.place, object.label(), "instances do not nest: a shapegroup cannot hold " + object.type + "s",
                           "place its shapes in the group themselves");
        return false;
    }
    for (const Child& inner : object.children) {
        if (inner.object == nullptr || (inner.object->tag != "emitter" && inner.object->tag != "sensor")) continue;
        context.faults.add(inner.place, inner.object->label(), "a shape in a shapegroup cannot hold an emitter or sensor",
                           "place the shape outside of the group");
        return false;
    }
    return true;
}

// The shapes an object holds, those of nested `merge`s among them.
std::vector<const Child*> held_shapes(Query& query) {
    std::vector<const Child*> shapes;
    for (const Child* child : query.children("shape")) {
        if (child->object->type != "merge") {
            shapes.push_back(child);
            continue;
        }
        Query inner(query.context(), *child->object);
        const std::vector<const Child*> merged = held_shapes(inner);
        shapes.insert(shapes.end(), merged.begin(), merged.end());
        inner.finish();
    }
    return shapes;
}

}  // namespace

int read_shape_group(Context& context, const Object& object) {
    const auto [known, fresh] = context.groups.try_emplace(&object, -1);
    if (!fresh) return known->second;
    Query query(context, object);
    ShapeGroup group;
    group.name = object.id;
    bool usable = !query.has_unresolved_children();
    for (const Child* child : held_shapes(query)) {
        if (!may_be_instanced(context, *child)) {
            usable = false;
        } else if (std::optional<Shape> shape = build_shape(context, *child->object)) {
            group.shapes.push_back(std::move(*shape));
        }
    }
    query.finish();
    if (!usable) return -1;
    context.scene.groups.push_back(std::move(group));
    return context.groups[&object] = static_cast<int>(context.scene.groups.size()) - 1;
}

// Mitsuba makes one mesh of those of one material, to save memory; the picture is the same.
void read_merged(Context& context, const Object& object) {
    Query query(context, object);
    for (const Child* child : held_shapes(query)) read_shape(context, *child->object);
    query.finish();
}

void read_instance(Context& context, const Object& object) {
    Query query(context, object);
    Instance instance;
    instance.to_world = glm::mat4(query.transform("to_world"));
    const std::vector<const Child*> shapes = query.children("shape");
    query.finish();
    if (query.has_unresolved_children()) return;
    if (shapes.size() != 1 || shapes.front()->object->type != "shapegroup") {
        query.fault("holds " + (shapes.size() == 1 ? "a " + shapes.front()->object->type : std::to_string(shapes.size()) + " shapes") +
                        "; expected one shapegroup",
                    "define a <shape type=\"shapegroup\" id=\"...\"> and refer to it");
        return;
    }
    instance.group = read_shape_group(context, *shapes.front()->object);
    if (instance.group >= 0) context.scene.instances.push_back(instance);
}

}  // namespace wavelobe::mitsuba
