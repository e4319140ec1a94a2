// Whole files in memory.
#pragma once

#include <string>

namespace wavelobe {

// Throws InputError naming the file when it is missing or cannot be read.
std::string read_file(const std::string& path);

// Throws the same errors without reading: for files that are needed later.
void require_file(const std::string& path);

}  // namespace wavelobe
