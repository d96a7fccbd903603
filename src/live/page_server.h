#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace flightwatt::live {

/// Serves a page at /, the current state at /state (JSON) and updates at /events (server-sent events). Read-only (GET,
/// HEAD). Answers only requests to an address or localhost and from its own origin, so that no other web site can read
/// it through a browser. Works in a thread of its own with a bounded number of connections; publish() does not block.
class PageServer {
  public:
    /// Points kept for pages opened later; beyond, every second one is removed.
    static constexpr std::size_t max_points = 1800;
    static constexpr std::size_t max_connections = 32;

    /// `at`: "8080" (this machine only) or "ADDRESS:PORT". Throws UsageError for any other text, InputError where it
    /// cannot listen.
    PageServer(std::string_view at, std::string page);
    ~PageServer();
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    /// "http://127.0.0.1:8080/"
    std::string address() const;
    /// Only this machine can connect.
    bool is_local() const;

    /// The current state, and its point in the charts (empty: none): JSON on one line.
    void publish(std::string state, std::string point);

  private:
    class Server;
    struct Session;
    std::unique_ptr<Server> server_;
};

}  // namespace flightwatt::live
