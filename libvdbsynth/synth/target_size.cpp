#include "libvdbsynth/synth/target_size.h"

#include "libvdbsynth/base/number_text.h"

namespace vdbsynth {

std::string Extent::text() const {
    return roundedText(mValue, 10) + (mMultiple ? "x" : "");
}

std::string TargetSize::text() const {
    return mExtents[0].text() + "," + mExtents[1].text() + "," + mExtents[2].text();
}

}  // namespace vdbsynth
