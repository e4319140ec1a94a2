// Adds up what each stage did and how long the device took for it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cl/program.h"
#include "render/render.h"

namespace wavelobe {

class StageTimer {
public:
    void add(const std::string& stage, std::uint64_t items, ClEvent event) {
        StageStats& row = rows_[stage];
        ++row.launches;
        row.items += items;
        pending_.emplace_back(&row, std::move(event));
    }

    // Reads the times of everything added so far. Call when the device has finished.
    void collect() {
        for (const auto& [row, event] : pending_) row->seconds += event_seconds(event);
        pending_.clear();
    }

    // In the given order; stages that never ran have a row of zeros.
    std::vector<StageStats> rows(const std::vector<std::string>& order) const {
        std::vector<StageStats> out;
        for (const std::string& name : order) {
            const auto found = rows_.find(name);
            StageStats row = found != rows_.end() ? found->second : StageStats{};
            row.name = name;
            out.push_back(row);
        }
        return out;
    }

private:
    std::map<std::string, StageStats> rows_;
    std::vector<std::pair<StageStats*, ClEvent>> pending_;
};

}  // namespace wavelobe
