#pragma once

#include <vector>

#include <sys/types.h>

namespace flightwatt::compute {

/// The living processes below `root` (children, their children, ...), from /proc. Zombies are not among them.
/// What a process forked away with setsid() is still below the nearest ancestor that is a subreaper
/// (PR_SET_CHILD_SUBREAPER).
std::vector<::pid_t> descendants_of(::pid_t root);

}  // namespace flightwatt::compute
