// What the fuzzing targets share: readers take files, and refuse them by InputError alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "scene/fault.h"

namespace wavelobe::fuzz {

inline std::string content_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

// A file in memory of that content; each process has one of each ending.
inline std::string write_file(const std::string& content, const std::string& ending) {
    static const std::string folder = [] {
        const std::string name = "/dev/shm/wavelobe_fuzz_" + std::to_string(getpid());
        std::filesystem::create_directories(name);
        std::atexit([] { std::filesystem::remove_all("/dev/shm/wavelobe_fuzz_" + std::to_string(getpid())); });
        return name;
    }();
    std::string path = folder + "/input" + ending;
    std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
    return path;
}

// Refusing is as good as reading; a refusal says something.
template <class Reader>
int refuse_or_read(const Reader& reader) {
    try {
        reader();
    } catch (const InputError& error) {
        if (error.faults().empty()) std::abort();
        for (const Fault& fault : error.faults())
            if (fault.message.empty()) std::abort();
    }
    return 0;
}

}  // namespace wavelobe::fuzz
