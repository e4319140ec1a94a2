// References between the objects of a document.
#include "scene/mitsuba/references.h"

#include <algorithm>
#include <map>

#include "scene/mitsuba/values.h"

namespace wavelobe::mitsuba {

namespace {

class CycleSearch {
public:
    explicit CycleSearch(Faults& faults) : faults_(faults) {}

    // Levels of objects below and including this one.
    std::size_t visit(Object& object) {
        path_.push_back(&object);
        std::size_t height = 0;
        for (Child& child : object.children) {
            if (child.object == nullptr) continue;
            const auto known = heights_.find(child.object);
            const std::size_t below = known != heights_.end() ? known->second : 1;
            if (path_.size() + below > max_object_depth + 1) {
                refuse_depth(child.place, object.label(), faults_);
                child.object = nullptr;
            } else if (known == heights_.end() && std::find(path_.begin(), path_.end(), child.object) != path_.end()) {
                faults_.add(child.place, "<ref>",
                            "`" + child.reference + "` refers back to the object that holds it", "break the loop");
                child.object = nullptr;
            } else {
                height = std::max(height, known != heights_.end() ? below : visit(*child.object));
            }
        }
        path_.pop_back();
        return heights_[&object] = height + 1;
    }

private:
    Faults& faults_;
    std::map<const Object*, std::size_t> heights_;  // of those that are done
    std::vector<const Object*> path_;
};

}  // namespace

void refuse_depth(const Place& place, const std::string& label, Faults& faults) {
    faults.add(place, label, "objects are nested more than " + std::to_string(max_object_depth) + " deep",
               "flatten the scene");
}

void resolve_references(Document& document, const std::map<std::string, Object*>& ids, Faults& faults) {
    std::vector<std::string> names;
    for (const auto& [id, object] : ids) names.push_back(id);
    for (Object& object : document.objects)
        for (Child& child : object.children) {
            if (child.reference.empty()) continue;
            const auto target = ids.find(child.reference);
            if (target != ids.end()) child.object = target->second;
            else
                faults.add(child.place, "<ref>", "no object has the id `" + child.reference + "`",
                           suggestion(child.reference, names));
        }
    if (document.root != nullptr) CycleSearch(faults).visit(*document.root);
}

}  // namespace wavelobe::mitsuba
