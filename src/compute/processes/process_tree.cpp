#include "compute/processes/process_tree.h"

#include "base/number.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace flightwatt::compute {
namespace {

struct ProcessEntry {
    ::pid_t parent = 0;
    bool living = false;
};

/// /proc/PID/stat is "PID (name) state parent ..."; the name may hold blanks and brackets.
ProcessEntry entry_of(const std::string& stat) {
    const auto bracket = stat.rfind(')');
    if (bracket == std::string::npos) return {};
    std::istringstream fields(stat.substr(bracket + 1));
    char state = 'Z';
    ProcessEntry entry;
    fields >> state >> entry.parent;
    entry.living = state != 'Z' && state != 'X';
    return entry;
}

std::multimap<::pid_t, std::pair<::pid_t, bool>> children_by_parent() {
    std::multimap<::pid_t, std::pair<::pid_t, bool>> children;
    std::error_code gone;  // a process may end while we look
    for (std::filesystem::directory_iterator it("/proc", gone), end; it != end; it.increment(gone)) {
        const auto pid = parse_unsigned(it->path().filename().string());
        if (!pid) continue;
        std::ifstream file(it->path() / "stat");
        std::string stat;
        if (!std::getline(file, stat, '\0')) continue;
        const auto entry = entry_of(stat);
        children.emplace(entry.parent, std::pair(static_cast<::pid_t>(*pid), entry.living));
    }
    return children;
}

}  // namespace

std::vector<::pid_t> descendants_of(::pid_t root) {
    const auto children = children_by_parent();
    std::vector<::pid_t> found;
    std::vector<::pid_t> open{root};
    while (!open.empty()) {
        const auto parent = open.back();
        open.pop_back();
        const auto [first, last] = children.equal_range(parent);
        for (auto child = first; child != last; ++child) {
            open.push_back(child->second.first);
            if (child->second.second) found.push_back(child->second.first);
        }
    }
    return found;
}

}  // namespace flightwatt::compute
