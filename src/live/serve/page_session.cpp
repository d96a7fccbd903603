#include "live/serve/page_session.h"

#include <chrono>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/status.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

namespace http = boost::beast::http;
using boost::beast::error_code;

constexpr std::chrono::seconds max_request{10}, max_write{20};
constexpr std::size_t max_request_bytes = 16'384;
constexpr std::size_t max_unsent_bytes = 2'000'000;  // a listener that takes nothing for minutes

std::string_view text_of(boost::beast::string_view text) { return {text.data(), text.size()}; }

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

constexpr int too_many = 503;

std::string whole_answer(int status, std::string_view type, std::string_view body, bool head_alone) {
    const auto* allow = status == 405 ? "Allow: GET, HEAD\r\n" : status == too_many ? "Retry-After: 30\r\n" : "";
    auto text = head_of(status, type, fmt::format("Content-Length: {}\r\n{}", body.size(), allow));
    if (!head_alone) text += body;
    return text;
}

std::string refusal(int status) {
    if (status == 403) return "Ask by the address of this machine or as localhost, and from its own page.\n";
    if (status == 405) return "This page is read alone.\n";
    if (status == too_many) return "As many pages as may be are open.\n";
    return "There is / and /state and /events.\n";
}

}  // namespace

PageSession::PageSession(boost::asio::ip::tcp::socket socket, const PageContents& contents,
                         std::function<void(const PageSession&)> on_end)
    : stream_(std::move(socket)), contents_(contents), on_end_(std::move(on_end)) {}

void PageSession::start() {
    parser_.emplace();
    parser_->header_limit(max_request_bytes);
    parser_->body_limit(max_request_bytes);
    stream_.expires_after(max_request);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](const error_code& error, std::size_t) {
                                if (self->closed_) return;
                                if (error) return self->close();
                                self->answer();
                            });
}

void PageSession::answer() {
    const auto& request = parser_->get();
    const auto target = text_of(request.target());
    const RequestHead head{.method = text_of(request.method_string()),
                           .target = target.substr(0, target.find('?')),
                           .host = text_of(request[http::field::host]),
                           .origin = text_of(request[http::field::origin]),
                           .fetch_site = text_of(request["Sec-Fetch-Site"])};
    const int status = status_of(head);
    const bool head_alone = head.method == "HEAD";
    constexpr int ok = 200;
    if (status != ok) {
        send(whole_answer(status, "text/plain; charset=utf-8", refusal(status), head_alone));
    } else if (head.target == "/") {
        send(whole_answer(status, "text/html; charset=utf-8", contents_.page, head_alone));
    } else if (head.target == "/state") {
        send(whole_answer(status, "application/json", contents_.state + "\n", head_alone));
    } else if (!head_alone && !contents_.has_room()) {
        send(whole_answer(too_many, "text/plain; charset=utf-8", refusal(too_many), head_alone));
    } else {
        is_listener_ = !head_alone;
        send(head_of(status, "text/event-stream", "") + (head_alone ? "" : contents_.first_events()));
        if (is_listener_) watch_for_end();
    }
}

void PageSession::send(std::string_view text) {
    if (closed_) return;
    if (outgoing_.size() + text.size() > max_unsent_bytes + contents_.page.size()) return close();
    outgoing_ += text;
    if (writing_.empty()) write_next();
}

void PageSession::write_next() {
    std::swap(writing_, outgoing_);
    if (writing_.empty()) {
        if (!is_listener_) close();
        return;
    }
    stream_.expires_after(max_write);
    boost::asio::async_write(stream_, boost::asio::buffer(writing_),
                             [self = shared_from_this()](const error_code& error, std::size_t) {
                                 self->writing_.clear();
                                 if (self->closed_) return;
                                 if (error) return self->close();
                                 self->stream_.expires_never();
                                 self->write_next();
                             });
}

/// A listener says nothing more: what can be read is its end.
void PageSession::watch_for_end() {
    stream_.socket().async_read_some(boost::asio::buffer(&beyond_, 1),
                                     [self = shared_from_this()](const error_code&, std::size_t) { self->close(); });
}

void PageSession::close() {
    if (std::exchange(closed_, true)) return;
    error_code ignored;
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_both, ignored);
    stream_.close();
    on_end_(*this);
}

}  // namespace flightwatt::live
