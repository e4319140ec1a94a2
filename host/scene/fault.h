// Faults of input files: collected, so that a user sees every one of a file in one go.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace wavelobe {

struct Fault {
    std::string file;
    int line = 0;    // 1-based; 0: not known
    int column = 0;  // 1-based; 0: not known
    std::string element;   // such as `shape[obj]`, may be empty
    std::string message;   // what is wrong; what was expected
    std::string hint;      // what to do, may be empty

    // `file:line:column: element: message; hint`
    std::string text() const {
        std::string where = file;
        if (line > 0) where += ":" + std::to_string(line);
        if (line > 0 && column > 0) where += ":" + std::to_string(column);
        std::string out = where.empty() ? std::string() : where + ": ";
        if (!element.empty()) out += element + ": ";
        out += message;
        if (!hint.empty()) out += "; " + hint;
        return out;
    }
};

// Thrown once, after everything that can be checked has been; the program prints one line a fault and
// exits with code 2.
class InputError : public std::runtime_error {
public:
    explicit InputError(std::vector<Fault> faults)
        : std::runtime_error(faults.empty() ? "invalid input" : faults.front().text()),
          faults_(std::move(faults)) {}
    explicit InputError(Fault fault) : InputError(std::vector<Fault>{std::move(fault)}) {}

    const std::vector<Fault>& faults() const { return faults_; }

private:
    std::vector<Fault> faults_;
};

}  // namespace wavelobe
