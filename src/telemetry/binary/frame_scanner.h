#pragma once

#include "telemetry/binary/frame.h"
#include "telemetry/message_dictionary.h"

#include <algorithm>
#include <bitset>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string_view>

namespace flightwatt::telemetry {

/// A run of bytes between frames.
struct Gap {
    std::size_t offset = 0;
    std::size_t bytes = 0;
    std::size_t zeros = 0;    ///< zeros at its end: preallocated space, not damage
    bool is_cut_off = false;  ///< begins with an incomplete frame
};

/// What may follow the scanned bytes.
enum class InputContinuation {
    more,   ///< more bytes, immediately
    pause,  ///< perhaps more bytes, later
    end,
};

/// Finds frames in bytes that may be damaged (docs/formats.md, "Damage"). Accepted are frames with a valid checksum
/// - whose message matches its definition, if another frame follows or no matching frame begins within;
/// - without a match, if no matching frame begins within, and a frame precedes or follows or the sender is known.
/// So a damaged length cannot hide the frames behind it.
template <Framing framing>
class FrameScanner {
  public:
    /// Scans by the definitions of `dictionary`, which must outlive this. Without a version, the one that matches more
    /// of the frames so far is used.
    FrameScanner(const MessageDictionary& dictionary, std::optional<LinkVersion> version)
        : dictionary_(&dictionary), version_(version) {}

    std::optional<LinkVersion> version() const { return version_ ? version_ : likely_version(); }

    /// Calls on_frame(FoundFrame, Frame) and on_gap(Gap) in the order of the bytes; a gap is reported with the frame
    /// that follows it, or at the end. Returns the number of processed bytes; pass the others again, with more behind
    /// them.
    template <typename OnFrame, typename OnGap>
    std::size_t scan(std::string_view bytes, InputContinuation behind, OnFrame&& on_frame, OnGap&& on_gap) {
        begin_ = bytes.data();
        end_ = begin_ + bytes.size();
        searched_ = begin_;
        fitting_ = nullptr;
        const char* p = begin_;
        while (p < end_) {
            if (*p != sync_byte(framing)) {
                const void* const next = std::memchr(p, sync_byte(framing), static_cast<std::size_t>(end_ - p));
                const char* const stop = next == nullptr ? end_ : static_cast<const char*>(next);
                skip(p, stop, false);
                p = stop;
                continue;
            }
            const auto status = parse(p, frame_);
            if (status == ParseStatus::incomplete && behind != InputContinuation::end &&
                !find_matching_frame(p + 1, end_))
                break;
            if (status == ParseStatus::frame) {
                const char* const stop = p + frame_.size;
                auto found = read(frame_, true);
                const bool is_sure = found.length_matches && looks_like_two_frames<framing>(stop, end_);
                const auto decision = is_sure ? FrameDecision::count : decide(found, p, stop, behind);
                if (decision == FrameDecision::wait) break;
                if (decision != FrameDecision::reject) {
                    close_gap(on_gap);
                    found.offset = offset_of(p);
                    in_sync_ = true;
                    if (found.length_matches) known_senders_.set(found.sender);
                    on_frame(static_cast<const FoundFrame&>(found), static_cast<const Frame&>(frame_));
                    p = decision == FrameDecision::count ? stop : fitting_;
                    continue;
                }
            }
            skip(p, p + 1, status == ParseStatus::incomplete);
            ++p;
        }
        const auto done = static_cast<std::size_t>(p - begin_);
        offset_ += done;
        if (behind == InputContinuation::end) close_gap(on_gap);
        return done;
    }

  private:
    enum class FrameDecision { count, count_both, reject, wait };

    FrameDecision decide(const FoundFrame& found, const char* p, const char* stop, InputContinuation behind) {
        const bool is_last = stop == end_;
        if (is_last &&
            (behind == InputContinuation::more || (behind == InputContinuation::pause && !found.length_matches)))
            return FrameDecision::wait;
        const bool is_followed = is_last || *stop == sync_byte(framing);
        if (found.length_matches && is_last) return FrameDecision::count;
        if (found.length_matches && is_followed) {
            const auto next = parse(stop, inner_);
            if (next == ParseStatus::incomplete && behind == InputContinuation::more) return FrameDecision::wait;
            if (next == ParseStatus::frame || (next == ParseStatus::incomplete && behind == InputContinuation::pause))
                return FrameDecision::count;
        }
        if (find_matching_frame(p + 1, stop)) {
            // A frame without its last byte, or without its first, may look complete with a byte of its neighbour:
            // both were sent, and which one is damaged is unknown.
            return found.length_matches && fitting_ >= stop - checksum_bytes(framing) ? FrameDecision::count_both
                                                                                      : FrameDecision::reject;
        }
        const bool counts = found.length_matches || in_sync_ || is_followed || known_senders_.test(found.sender);
        return counts ? FrameDecision::count : FrameDecision::reject;
    }

    /// Parses a frame; of an XBee's packet that is valid both unescaped and escaped, the one whose message matches.
    ParseStatus parse(const char* p, Frame& frame) {
        const auto status = parse_frame<framing>(p, end_, frame);
        if constexpr (framing == Framing::xbee) {
            if (status != ParseStatus::frame || read(frame, false).length_matches) return status;
            for (const bool escaped : {false, true}) {
                if (parse_xbee_frame(p, end_, escaped, other_) != ParseStatus::frame ||
                    !read(other_, false).length_matches)
                    continue;
                return parse_xbee_frame(p, end_, escaped, frame);
            }
        }
        return status;
    }

    /// Reads a frame's message by the version, if it is known; `counts` states whether the frame is used to detect it.
    FoundFrame read(const Frame& frame, bool counts) {
        return version_ ? read_message_header(frame, *version_, *dictionary_) : read_of_any_version(frame, counts);
    }

    FoundFrame read_of_any_version(const Frame& frame, bool counts) {
        const auto v1 = read_message_header(frame, LinkVersion::v1, *dictionary_);
        const auto v2 = read_message_header(frame, LinkVersion::v2, *dictionary_);
        if (counts && v1.length_matches != v2.length_matches) ++(v1.length_matches ? fit_v1_ : fit_v2_);
        if (const auto likely = likely_version()) return *likely == LinkVersion::v1 ? v1 : v2;
        if (v1.length_matches && (!v2.length_matches || v2.class_id != MessageDictionary::telemetry_class)) return v1;
        if (v2.length_matches && !v1.length_matches) return v2;
        FoundFrame undecided = v1;
        undecided.message = nullptr;
        undecided.length_matches = false;
        return undecided;
    }

    std::optional<LinkVersion> likely_version() const {
        if (fit_v1_ == fit_v2_) return std::nullopt;
        return fit_v1_ > fit_v2_ ? LinkVersion::v1 : LinkVersion::v2;
    }

    /// Returns whether a matching frame begins in [from, to). Each byte is searched once.
    bool find_matching_frame(const char* from, const char* to) {
        if (fitting_ != nullptr && fitting_ >= from) return fitting_ < to;
        fitting_ = nullptr;
        for (const char* p = std::max(from, searched_); p < to; ++p) {
            const void* const next = std::memchr(p, sync_byte(framing), static_cast<std::size_t>(to - p));
            if (next == nullptr) break;
            p = static_cast<const char*>(next);
            if (parse(p, inner_) != ParseStatus::frame || !read(inner_, false).length_matches) continue;
            fitting_ = p;
            searched_ = p + 1;
            return true;
        }
        searched_ = std::max(searched_, to);
        return false;
    }

    std::size_t offset_of(const char* p) const { return offset_ + static_cast<std::size_t>(p - begin_); }

    void skip(const char* from, const char* to, bool is_incomplete) {
        if (gap_.bytes == 0) gap_ = {offset_of(from), 0, 0, in_sync_ && is_incomplete};
        in_sync_ = false;
        const auto bytes = static_cast<std::size_t>(to - from);
        std::size_t zeros = 0;
        while (zeros < bytes && to[-1 - static_cast<std::ptrdiff_t>(zeros)] == '\0') ++zeros;
        gap_.zeros = zeros == bytes ? gap_.zeros + zeros : zeros;
        gap_.bytes += bytes;
    }

    template <typename OnGap>
    void close_gap(OnGap&& on_gap) {
        if (gap_.bytes > 0) on_gap(static_cast<const Gap&>(gap_));
        gap_ = {};
    }

    const MessageDictionary* dictionary_;
    std::optional<LinkVersion> version_;
    std::size_t fit_v1_ = 0;
    std::size_t fit_v2_ = 0;
    std::bitset<256> known_senders_;
    bool in_sync_ = true;  ///< the next byte directly follows a frame
    Gap gap_;
    std::size_t offset_ = 0;  ///< of begin_
    const char* begin_ = nullptr;
    const char* end_ = nullptr;
    const char* searched_ = nullptr;  ///< before this no matching frame begins, except
    const char* fitting_ = nullptr;   ///< this one
    Frame frame_;
    Frame inner_;
    Frame other_;
};

}  // namespace flightwatt::telemetry
