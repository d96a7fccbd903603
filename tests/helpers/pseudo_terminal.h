#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

namespace flightwatt::test {

/// A serial line with someone at its other end.
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

  private:
    int file_;
};

}  // namespace flightwatt::test
