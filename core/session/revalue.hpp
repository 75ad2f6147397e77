#pragma once

#include "core/session/session.hpp"

namespace bowstring {

/// Gives one number of an energy or a constraint another value, where that changes numbers alone: no place that is
/// read, no field, no row, no message. Then the session is what `prepare` would make of that override. Otherwise, and
/// where the override is wrong, answers false and leaves the session as it was: the composition has to be read again.
bool revalue(Session& session, const Override& change);

/// Lets terms see another step before: CurveView::previous of each curve, empty for none. Laws are made anew; false
/// where they would read other places, and then the scene has to be built anew with that state. `previous` of no curves
/// changes nothing.
bool show_previous(Session& session, const std::vector<std::vector<double>>& previous);

}  // namespace bowstring
