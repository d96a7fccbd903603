#include "live/page_server.h"

#include "base/error.h"
#include "base/number.h"
#include "live/sources/endpoints.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <list>
#include <random>
#include <thread>
#include <utility>

#include <boost/algorithm/string/predicate.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/status.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::algorithm::iequals;
using boost::system::error_code;

constexpr std::chrono::seconds max_request{10}, max_write{20};
constexpr std::size_t max_request_bytes = 16'384;
constexpr std::size_t max_unsent_bytes = 2'000'000;  // a listener that takes nothing for minutes

constexpr int ok = 200, forbidden = 403, not_found = 404, not_allowed = 405, too_many = 503;

std::string_view text_of(boost::beast::string_view text) { return {text.data(), text.size()}; }

/// Without its port; empty where that is none.
std::string_view without_port(std::string_view host) {
    const auto end = host.starts_with('[') ? host.find(']') : std::string_view::npos;
    const auto colon = host.find(':', end == std::string_view::npos ? 0 : end);
    if (colon == std::string_view::npos) return host;
    return parse_unsigned(host.substr(colon + 1)) ? host.substr(0, colon) : std::string_view();
}

/// Whether a Host header names this machine by an address, or as localhost: a name that some name server made an
/// address of this machine's is neither.
bool is_own_host(std::string_view host) {
    auto name = without_port(host);
    if (iequals(name, "localhost")) return true;
    if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
    boost::system::error_code error;
    boost::asio::ip::make_address(std::string(name), error);
    return !error;
}

/// How a request is answered: 200, 403, 404 or 405.
int status_of(const http::request<http::empty_body>& request, std::string_view target) {
    const auto host = text_of(request[http::field::host]);
    const auto origin = text_of(request[http::field::origin]);
    const auto fetch_site = text_of(request["Sec-Fetch-Site"]);
    if (!is_own_host(host)) return forbidden;
    if (!origin.empty() && !iequals(origin, "http://" + std::string(host))) return forbidden;
    if (request.method() != http::verb::get && request.method() != http::verb::head) return not_allowed;
    if (target == "/") return ok;  // also by a link on another page
    if (target != "/state" && target != "/events") return not_found;
    return fetch_site.empty() || fetch_site == "same-origin" || fetch_site == "none" ? ok : forbidden;
}

/// The page may load nothing but what is here; Vega compiles its expressions.
constexpr std::string_view head_for_all =
    "Cache-Control: no-store\r\nConnection: close\r\nX-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\n"
    "Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n"
    "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; "
    "img-src data: blob:; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'\r\n";

std::string head_of(int status, std::string_view type, std::string_view more) {
    return fmt::format("HTTP/1.1 {} {}\r\nContent-Type: {}\r\n{}{}\r\n", status,
                       text_of(http::obsolete_reason(static_cast<http::status>(status))), type, head_for_all, more);
}

std::string whole_answer(int status, std::string_view type, std::string_view body, bool head_alone) {
    const auto* allow = status == not_allowed ? "Allow: GET, HEAD\r\n"
                        : status == too_many  ? "Retry-After: 30\r\n"
                                              : "";
    auto text = head_of(status, type, fmt::format("Content-Length: {}\r\n{}", body.size(), allow));
    if (!head_alone) text += body;
    return text;
}

std::string refusal(int status) {
    if (status == forbidden) return "Ask by the address of this machine or as localhost, and from its own page.\n";
    if (status == not_allowed) return "This page is read alone.\n";
    if (status == too_many) return "As many pages as may be are open.\n";
    return "There is / and /state and /events.\n";
}

std::string event_of(std::string_view name, std::string_view data) {
    return fmt::format("event: {}\ndata: {}\n\n", name, data);
}

tcp::endpoint parse_listening_address(std::string_view at) {
    const auto where = parse_host_and_port(at, "127.0.0.1");
    if (where) return {asio::ip::make_address(where->host), where->port};
    throw UsageError(fmt::format("--serve {}: expected PORT or ADDRESS:PORT, as 8080 or 127.0.0.1:8080", at));
}

}  // namespace

/// A connection of a browser: one request, one answer, which for a listener does not end.
class PageServer::Session : public std::enable_shared_from_this<Session> {
  public:
    Session(tcp::socket socket, Server& server) : stream_(std::move(socket)), server_(server) {}

    void start() {
        parser_.header_limit(max_request_bytes);
        parser_.body_limit(max_request_bytes);
        stream_.expires_after(max_request);
        http::async_read_header(stream_, buffer_, parser_,
                                [self = shared_from_this()](const error_code& error, std::size_t) {
                                    if (self->closed_) return;
                                    if (error) return self->close();
                                    self->answer();
                                });
    }
    bool is_listener() const { return is_listener_; }
    void send(std::string_view text);
    void close();

  private:
    void answer();
    void write_next();

    boost::beast::tcp_stream stream_;
    Server& server_;
    boost::beast::flat_buffer buffer_;
    http::request_parser<http::empty_body> parser_;
    std::string outgoing_, writing_;
    char beyond_ = '\0';
    bool is_listener_ = false, closed_ = false;
};

class PageServer::Server {
  public:
    Server(const tcp::endpoint& at, std::string page) : page_(std::move(page)), acceptor_(context_), timer_(context_) {
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
    const std::string& page() const { return page_; }
    const std::string& state() const { return state_; }

    void publish(std::string state, std::string point) {
        asio::post(context_, [this, state = std::move(state), point = std::move(point)]() mutable {
            tell(std::move(state), std::move(point));
        });
    }

    /// Which run of the program this is, so that a page that comes back knows, and what was until now.
    std::string first_events() const {
        std::string points;
        for (const auto& point : points_) points += (points.empty() ? "" : ",") + point;
        return "retry: 1000\n\n" + event_of("begin", fmt::format(R"({{"run":"{}","points":[{}]}})", run_, points)) +
               event_of("state", state_);
    }
    /// For one more listener.
    bool has_room() const {
        const auto listeners = std::ranges::count_if(sessions_, [](const auto& of) { return of->is_listener(); });
        return listeners < static_cast<std::ptrdiff_t>(max_connections);
    }
    void remove(const std::shared_ptr<Session>& session) { sessions_.remove(session); }

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
                timer_.expires_after(std::chrono::milliseconds(500));
                timer_.async_wait([this](const error_code& stopped) {
                    if (!stopped) accept();
                });
                return;
            }
            close_on_exec(socket);
            if (sessions_.size() >= 2 * max_connections) close_oldest_asker();
            const auto session = std::make_shared<Session>(std::move(socket), *this);
            sessions_.push_back(session);
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

    void tell(std::string state, std::string point) {
        state_ = std::move(state);
        const auto event = event_of("state", state_);
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

    const std::string page_;
    std::string state_ = "null";
    asio::io_context context_;
    tcp::acceptor acceptor_;
    asio::steady_timer timer_;
    tcp::endpoint endpoint_;
    std::deque<std::string> points_;
    std::list<std::shared_ptr<Session>> sessions_;
    const std::string run_ = new_run();
    std::thread thread_;
};

void PageServer::Session::answer() {
    const auto& request = parser_.get();
    const auto target = text_of(request.target().substr(0, request.target().find('?')));
    const int status = status_of(request, target);
    const bool head_alone = request.method() == http::verb::head;
    if (status != ok) {
        send(whole_answer(status, "text/plain; charset=utf-8", refusal(status), head_alone));
    } else if (target == "/") {
        send(whole_answer(status, "text/html; charset=utf-8", server_.page(), head_alone));
    } else if (target == "/state") {
        send(whole_answer(status, "application/json", server_.state() + "\n", head_alone));
    } else if (!head_alone && !server_.has_room()) {
        send(whole_answer(too_many, "text/plain; charset=utf-8", refusal(too_many), head_alone));
    } else {
        is_listener_ = !head_alone;
        send(head_of(status, "text/event-stream", "") + (head_alone ? "" : server_.first_events()));
        if (!is_listener_) return;
        // A listener says nothing more: what can be read is its end.
        stream_.socket().async_read_some(
            asio::buffer(&beyond_, 1), [self = shared_from_this()](const error_code&, std::size_t) { self->close(); });
    }
}

void PageServer::Session::send(std::string_view text) {
    if (closed_) return;
    if (outgoing_.size() + text.size() > max_unsent_bytes + server_.page().size()) return close();
    outgoing_ += text;
    if (writing_.empty()) write_next();
}

void PageServer::Session::write_next() {
    std::swap(writing_, outgoing_);
    if (writing_.empty()) {
        if (!is_listener_) close();
        return;
    }
    stream_.expires_after(max_write);
    asio::async_write(stream_, asio::buffer(writing_),
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                          self->writing_.clear();
                          if (self->closed_) return;
                          if (error) return self->close();
                          self->stream_.expires_never();
                          self->write_next();
                      });
}

void PageServer::Session::close() {
    if (std::exchange(closed_, true)) return;
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_both, ignored);
    stream_.close();
    server_.remove(shared_from_this());
}

PageServer::PageServer(std::string_view at, std::string page)
    : server_(std::make_unique<Server>(parse_listening_address(at), std::move(page))) {}

PageServer::~PageServer() = default;

std::string PageServer::address() const {
    const auto at = server_->endpoint();
    const auto host = at.address().is_unspecified() ? std::string("127.0.0.1") : at.address().to_string();
    return at.address().is_v6() ? fmt::format("http://[{}]:{}/", host, at.port())
                                : fmt::format("http://{}:{}/", host, at.port());
}

void PageServer::publish(std::string state, std::string point) { server_->publish(std::move(state), std::move(point)); }

}  // namespace flightwatt::live
