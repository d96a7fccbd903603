#pragma once

#include "answer/answer.h"
#include "answer/answered.h"
#include "answer/failsafe.h"
#include "answer/pack_answer.h"
#include "answer/pack_ledger.h"
#include "cli/stage.h"

#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::answer {
Fields<Answered> record_fields(const Answered*);
Fields<FailsafeCard> record_fields(const FailsafeCard*);
}  // namespace flightwatt::answer

/// Output of `flightwatt LOG...`: the answers about one aircraft; and JSON of the failsafe card.
namespace flightwatt::cli {

/// The answers about one aircraft.
struct AircraftAnswer {
    std::string aircraft;   ///< a text for --aircraft; the only flight's name where nothing identifies it
    std::string name;       ///< "ArduCopter"; may be empty
    std::string folder;     ///< of its batch
    std::size_t logs = 0;   ///< that were read for it
    std::size_t used = 0;   ///< flights of the model
    std::string no_answer;  ///< why nothing is answered; empty if something is
    answer::Question question;
    answer::Endurance endurance;
    answer::PackAnswer pack;
    std::vector<answer::Pack> packs;               ///< that the flights name, with their health
    answer::Answered prediction_error_percent;     ///< of the energy of flights left out
    std::optional<answer::FailsafeCard> failsafe;  ///< of the mission that is asked for
    std::string failsafe_missing;                  ///< the reason why it is absent
    std::string requirement_missed;                ///< why --require is missed; empty: not, or nothing is required
    std::string page;                              ///< file of the report; empty without one
};
Fields<AircraftAnswer> record_fields(const AircraftAnswer*);

/// What is asked and its answer: the value with what it rests on, or why it is unknown.
struct AnswerLine {
    std::string label;
    std::string text;
    std::string on_terminal;  ///< ends the text where files of this computer are named
};

/// Returns "2A002500 (ArduCopter): 3 flights used of 3 logs".
std::string aircraft_line(const AircraftAnswer& answer);

/// Returns the lines below it: where nothing is answered, the reason alone.
std::vector<AnswerLine> answer_lines(const AircraftAnswer& answer);

/// Returns labels with their texts, broken between words at `columns`.
std::string lines_text(const std::vector<AnswerLine>& lines, std::size_t columns);

/// At most ten lines for a pilot, broken between words at `columns`.
std::string answer_text(const AircraftAnswer& answer, std::size_t columns);

}  // namespace flightwatt::cli
