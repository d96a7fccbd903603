#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/stage.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

namespace flightwatt::cli {

void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) {
        throw OutputError(fmt::format("cannot write the standard output: {}", std::strerror(errno)));
    }
}

void write_result(const StageCall& call, std::string_view content) {
    if (call.output) {
        write_file_atomically(*call.output, content);
    } else if (!call.json) {
        print(content);
    }
}

void warn(const StageCall& call, std::string_view message) {
    fmt::print(stderr, "{}: warning: {}\n", call.program, message);
}

void note(const StageCall& call, std::string_view message) {
    fmt::print(stderr, "{}: {}\n", call.program, message);
}

}  // namespace flightwatt::cli
