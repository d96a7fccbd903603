#pragma once

#include <functional>
#include <thread>

namespace flightwatt::live {

/// A thread that is given no signals: they are for the one that the program waits in.
std::thread start_without_signals(std::function<void()> work);

}  // namespace flightwatt::live
