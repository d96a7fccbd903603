#include "live/page_server.h"

#include "base/error.h"
#include "live/serve/page_session.h"
#include "live/sources/endpoints.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <list>
#include <random>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::milliseconds try_again{500};
constexpr std::size_t max_posted = 64;

std::string event_of(std::string_view name, std::string_view data) {
    return fmt::format("event: {}\ndata: {}\n\n", name, data);
}

/// JSON has no line breaks but between its parts.
std::string on_one_line(std::string_view json) {
    std::string text(json);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return text;
}

tcp::endpoint parse_listening_address(std::string_view at) {
    const auto where = parse_host_and_port(at, "127.0.0.1");
    if (where) return {asio::ip::make_address(where->host), where->port};
    throw UsageError(fmt::format("--serve {}: expected PORT or ADDRESS:PORT, as 8080 or 127.0.0.1:8080", at));
}

}  // namespace

class PageServer::Server {
  public:
    Server(const tcp::endpoint& at, std::string page) : acceptor_(context_), timer_(context_) {
        contents_.page = std::move(page);
        contents_.first_events = [this] { return first_events(); };
        contents_.has_room = [this] {
            const auto listeners = std::ranges::count_if(sessions_, [](const auto& of) { return of->is_listener(); });
            return listeners < static_cast<std::ptrdiff_t>(max_connections);
        };
        listen(at);
        accept();
        thread_ = start_without_signals([this] { context_.run(); });
    }
    ~Server() {
        asio::post(context_, [this] { stop(); });
        thread_.join();
    }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    tcp::endpoint endpoint() const { return endpoint_; }

    void publish(std::string state, std::string point) {
        if (posted_ >= max_posted) return;  // the machine has no time for pages
        ++posted_;
        asio::post(context_, [this, state = std::move(state), point = std::move(point)]() mutable {
            --posted_;
            tell(std::move(state), std::move(point));
        });
    }

  private:
    void listen(const tcp::endpoint& at) {
        error_code error;
        acceptor_.open(at.protocol(), error);
        if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
        if (!error) acceptor_.bind(at, error);
        if (!error) acceptor_.listen(max_connections, error);
        if (error) {
            throw InputError({fmt::format("--serve {}:{}", at.address().to_string(), at.port())},
                             fmt::format("cannot listen: {}", error.message()),
                             "see which program has the port (ss -ltp), or take another one");
        }
        close_on_exec(acceptor_);
        endpoint_ = acceptor_.local_endpoint();
    }

    void accept() {
        acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
            if (!acceptor_.is_open()) return;
            if (error) {  // no files left
                timer_.expires_after(try_again);
                timer_.async_wait([this](const error_code& stopped) {
                    if (!stopped) accept();
                });
                return;
            }
            close_on_exec(socket);
            if (sessions_.size() >= 2 * max_connections) close_oldest_asker();
            const auto on_end = [this](const PageSession& ended) {
                sessions_.remove_if([&](const auto& session) { return session.get() == &ended; });
            };
            sessions_.push_back(std::make_shared<PageSession>(std::move(socket), contents_, on_end));
            const auto session = sessions_.back();
            session->start();
            accept();
        });
    }

    /// Of those that are no pages: they have been answered, or never asked.
    void close_oldest_asker() {
        const auto asker = std::ranges::find_if(sessions_, [](const auto& of) { return !of->is_listener(); });
        if (asker == sessions_.end()) return;
        const auto closed = *asker;  // it takes itself off the list
        closed->close();
    }

    /// Which run of the program this is, so that a page that comes back knows, and what was until now.
    std::string first_events() const {
        std::string points;
        for (const auto& point : points_) points += (points.empty() ? "" : ",") + point;
        return "retry: 1000\n\n" + event_of("begin", fmt::format(R"({{"run":"{}","points":[{}]}})", run_, points)) +
               event_of("state", contents_.state);
    }

    void tell(std::string state, std::string point) {
        contents_.state = std::move(state);
        const auto event = event_of("state", contents_.state);
        const auto sessions = sessions_;  // a session that ends takes itself off the list
        for (const auto& session : sessions) {
            if (session->is_listener()) session->send(event);
        }
        if (point.empty()) return;
        points_.push_back(std::move(point));
        if (points_.size() > max_points) thin();
    }

    /// The newest quarter stays as it is.
    void thin() {
        std::deque<std::string> kept;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (i % 2 == 0 || i > points_.size() * 3 / 4) kept.push_back(std::move(points_[i]));
        }
        points_ = std::move(kept);
    }

    void stop() {
        error_code ignored;
        acceptor_.close(ignored);
        timer_.cancel(ignored);
        const auto sessions = sessions_;
        for (const auto& session : sessions) session->close();
    }

    static std::string new_run() {
        std::random_device random;
        return fmt::format("{:08x}{:08x}", random(), random());
    }

    asio::io_context context_;
    tcp::acceptor acceptor_;
    asio::steady_timer timer_;
    tcp::endpoint endpoint_;
    PageContents contents_;
    std::deque<std::string> points_;
    std::list<std::shared_ptr<PageSession>> sessions_;
    std::atomic<std::size_t> posted_{0};
    const std::string run_ = new_run();
    std::thread thread_;
};

PageServer::PageServer(std::string_view at, std::string page)
    : server_(std::make_unique<Server>(parse_listening_address(at), std::move(page))) {}

PageServer::~PageServer() = default;

std::string PageServer::address() const {
    const auto at = server_->endpoint();
    const auto host = at.address().is_unspecified() ? std::string("127.0.0.1") : at.address().to_string();
    return at.address().is_v6() ? fmt::format("http://[{}]:{}/", host, at.port())
                                : fmt::format("http://{}:{}/", host, at.port());
}

void PageServer::publish(std::string_view state, std::string_view point) {
    server_->publish(on_one_line(state), on_one_line(point));
}

}  // namespace flightwatt::live
