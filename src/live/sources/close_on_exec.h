#pragma once

#include <fcntl.h>

namespace flightwatt::live {

/// Commands that are run meanwhile do not hold a port or a device. (Asio leaves that open.)
template <typename Opened>
void close_on_exec(Opened& opened) {
    ::fcntl(opened.native_handle(), F_SETFD, FD_CLOEXEC);
}

}  // namespace flightwatt::live
