// Checked OpenCL calls: the message quotes the call that failed.
#pragma once

#include <CL/cl.h>

#include <stdexcept>
#include <string>

namespace wavelobe {

class ClError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

std::string cl_error_name(cl_int code);

inline void cl_check(cl_int code, const char* call) {
    if (code != CL_SUCCESS) throw ClError(std::string(call) + " failed: " + cl_error_name(code));
}

}  // namespace wavelobe

#define CL_CHECK(call) ::wavelobe::cl_check((call), #call)
