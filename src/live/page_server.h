#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace flightwatt::live {

/// A page for browsers on this machine: the page itself at /, what is known now at /state (JSON), and what is new at
/// /events (server-sent events), which the page listens to. It is read alone: GET and HEAD. It answers those who ask it
/// by an address or as localhost, and no page of another origin, so that no web site reaches it through its visitor's
/// browser. It works in a thread of its own, with a bounded number of connections; one that does not take what it is
/// sent is closed. Whoever publishes waits for nothing.
class PageServer {
  public:
    /// Points that are kept for pages that are opened later; of more, every second one of the older ones goes.
    static constexpr std::size_t max_points = 1800;
    static constexpr std::size_t max_connections = 32;

    /// `at`: "8080" (this machine alone), "ADDRESS:PORT". Throws UsageError for what is none, InputError where it
    /// cannot listen there.
    PageServer(std::string_view at, std::string page);
    ~PageServer();
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    /// "http://127.0.0.1:8080/"
    std::string address() const;

    /// What is known now, and of it what a page that is opened later draws (empty: nothing): JSON on one line.
    void publish(std::string state, std::string point);

  private:
    class Server;
    class Session;
    std::unique_ptr<Server> server_;
};

}  // namespace flightwatt::live
