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
    /// Maximum number of points kept for pages that are opened later; at more, every second one is removed.
    static constexpr std::size_t max_points = 1800;
    static constexpr std::size_t max_connections = 32;

    /// Serves `page` at "8080" (for this machine only) or "ADDRESS:PORT". Throws UsageError for any other text,
    /// InputError if it cannot listen there.
    PageServer(std::string_view at, std::string page);
    ~PageServer();
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    /// Returns the address of the page: "http://127.0.0.1:8080/".
    std::string address() const;
    /// Returns whether only this machine can connect.
    bool is_local() const;

    /// Sends the current state, and its point in the charts (empty: none), to all open pages: each is JSON on one line.
    void publish(std::string state, std::string point);

  private:
    class Server;
    struct Session;
    std::unique_ptr<Server> server_;
};

}  // namespace flightwatt::live
