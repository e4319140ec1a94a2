// Scene files written for a test, in a folder that goes away with it.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scene/fault.h"
#include "scene/mitsuba_reader.h"

namespace wavelobe::test {

class SceneFolder {
public:
    SceneFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "wavelobe-XXXXXX").string();
        if (mkdtemp(pattern.data()) != nullptr) folder_ = pattern;
    }
    ~SceneFolder() {
        if (!folder_.empty()) std::filesystem::remove_all(folder_);
    }
    SceneFolder(const SceneFolder&) = delete;
    SceneFolder& operator=(const SceneFolder&) = delete;

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    std::string write(const std::string& name, const std::string& content) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(path(name), std::ios::binary) << content;
        return path(name);
    }

    // The scene of a file that holds just this text.
    Scene read(const std::string& xml, const Definitions& definitions = {}) const {
        return read_mitsuba_scene(write("scene.xml", xml), definitions);
    }

    // The scene of these elements and a sensor, in an outer <scene>.
    Scene elements(const std::string& xml) const { return read(wrap(xml)); }

    std::vector<Fault> faults(const std::string& xml, const Definitions& definitions = {}) const {
        try {
            read(xml, definitions);
        } catch (const InputError& error) {
            return error.faults();
        }
        return {};
    }

    std::vector<Fault> element_faults(const std::string& xml) const { return faults(wrap(xml)); }

    // The elements start on line 2.
    static std::string wrap(const std::string& xml) {
        return "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>\n" + xml + "\n</scene>\n";
    }

private:
    std::filesystem::path folder_;
};

inline std::string texts(const std::vector<Fault>& faults) {
    std::string all;
    for (const Fault& fault : faults) all += fault.text() + "\n";
    return all;
}

inline bool has_text(const std::vector<Fault>& faults, const std::string& text) {
    return texts(faults).find(text) != std::string::npos;
}

}  // namespace wavelobe::test
