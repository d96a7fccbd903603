#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace flightwatt::test {

/// A serial line with somebody at its other end.
class PseudoTerminal {
  public:
    /// `link` becomes its name.
    explicit PseudoTerminal(const std::filesystem::path& link) : file_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
        if (file_ < 0 || ::grantpt(file_) != 0 || ::unlockpt(file_) != 0)
            throw std::runtime_error("no pseudo-terminal");
        ::termios mode{};
        ::tcgetattr(file_, &mode);
        ::cfmakeraw(&mode);
        ::tcsetattr(file_, TCSANOW, &mode);
        std::string name(100, '\0');
        if (::ptsname_r(file_, name.data(), name.size()) != 0) throw std::runtime_error("no name");
        std::filesystem::remove(link);
        std::filesystem::create_symlink(name.c_str(), link);
    }
    ~PseudoTerminal() { ::close(file_); }
    PseudoTerminal(const PseudoTerminal&) = delete;
    PseudoTerminal& operator=(const PseudoTerminal&) = delete;

    void send(std::string_view bytes) const {
        while (!bytes.empty()) {
            const auto sent = ::write(file_, bytes.data(), std::min<std::size_t>(bytes.size(), 100));
            if (sent <= 0) throw std::runtime_error("nothing was sent");
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
    }
    /// What has come within 20 ms.
    std::string receive() const {
        constexpr int wait_ms = 20;
        ::pollfd line{file_, POLLIN, 0};
        std::array<char, 4096> bytes{};
        if (::poll(&line, 1, wait_ms) <= 0) return {};
        const auto count = ::read(file_, bytes.data(), bytes.size());
        if (count <= 0) ::usleep(wait_ms * 1000);  // nobody has opened it
        return count > 0 ? std::string(bytes.data(), static_cast<std::size_t>(count)) : std::string();
    }

  private:
    int file_;
};

/// Two serial lines: what is written to the first can be read from the second.
class NullModem {
  public:
    NullModem(const std::filesystem::path& from, const std::filesystem::path& to) : from_(from), to_(to) {
        thread_ = std::thread([this] {
            while (!stopped_) to_.send(from_.receive());
        });
    }
    ~NullModem() {
        stopped_ = true;
        thread_.join();
    }
    NullModem(const NullModem&) = delete;
    NullModem& operator=(const NullModem&) = delete;

  private:
    PseudoTerminal from_;
    PseudoTerminal to_;
    std::atomic<bool> stopped_ = false;
    std::thread thread_;
};

}  // namespace flightwatt::test
