// Output files that are either whole or absent: written under a temporary name beside the target, then renamed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace wavelobe {

// The file that `path` leads to: absolute, links followed. Two names of one file give the same.
std::filesystem::path output_target(const std::string& path);

// Throws InputError saying why `path` cannot become an output file: its folder is missing or not writable, or it is a
// folder, a device or a file without write permission. Leaves nothing behind.
void refuse_unwritable(const std::string& path);

// Puts `bytes` at `path`. On failure throws std::runtime_error and leaves an existing file untouched.
// A symbolic link stays one: the file it leads to is replaced.
void replace_file(const std::string& path, std::string_view bytes);

}  // namespace wavelobe
