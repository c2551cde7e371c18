#pragma once
#include <string>

#include "uplift/study/trust.h"

namespace uplift {

/// trust.json: runs, bands of the verdict's numbers (SI), spectra with their bands, and what was not changed.
std::string trust_json(const TrustAnswer&);
/// Its JSON Schema.
std::string trust_schema();

/// In one sentence: how wide the bands of the leading numbers are, and which choice is behind it.
std::string trust_sentence(const TrustAnswer&);

}  // namespace uplift
