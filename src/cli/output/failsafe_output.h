#pragma once

#include "answer/failsafe.h"
#include "record/record.h"

/// JSON of the failsafe card.
namespace flightwatt::answer {

Fields<FailsafeCard> record_fields(const FailsafeCard*);

}  // namespace flightwatt::answer
