// Adds up what each stage did and how long the device took for it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cl/program.h"
#include "render/features.h"
#include "shared/block.h"

namespace wavelobe {

class StageTimer {
public:
    void add(std::uint32_t stage, const StageStats& more) {
        StageStats& row = rows_[stage];
        row.launches += more.launches;
        row.items += more.items;
        row.seconds += more.seconds;
    }

    // A launch of a stage's own kernel.
    void add_launch(std::uint32_t stage, std::uint64_t items, ClEvent event) {
        add(stage, {.name = {}, .launches = 1, .items = items, .seconds = 0.0});
        pending_.emplace_back(stage, std::move(event));
    }

    // Reads the times of every launch added so far. Call when the device has finished.
    void collect() {
        for (const auto& [stage, event] : pending_) rows_[stage].seconds += event_seconds(event);
        pending_.clear();
    }

    std::uint64_t items(std::uint32_t stage) const {
        const auto found = rows_.find(stage);
        return found != rows_.end() ? found->second.items : 0;
    }

    // The scene's stages in order; those that never ran have a row of zeros.
    std::vector<StageStats> rows(const FeatureSet& features) const {
        std::vector<StageStats> out;
        for (std::uint32_t stage = 0; stage < STAGE_COUNT; ++stage) {
            if (!features.has_stage(stage)) continue;
            const auto found = rows_.find(stage);
            out.push_back(found != rows_.end() ? found->second : StageStats{});
            out.back().name = stage_name(stage);
        }
        return out;
    }

private:
    std::map<std::uint32_t, StageStats> rows_;
    std::vector<std::pair<std::uint32_t, ClEvent>> pending_;
};

}  // namespace wavelobe
