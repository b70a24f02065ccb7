#include "optics/src/embree_handles.h"

#include "cad_import/error.h"

namespace catoptra::optics {

void check_embree(RTCDevice device, const std::string& doing) {
  switch (rtcGetDeviceError(device)) {
    case RTC_ERROR_NONE:
      return;
    case RTC_ERROR_OUT_OF_MEMORY:
      throw Error("", "ray scene", doing + ": out of memory", "use fewer or coarser surroundings");
    case RTC_ERROR_UNSUPPORTED_CPU:
      throw Error("", "ray scene", doing + ": this processor is not supported", "SSE2 at least is needed");
    case RTC_ERROR_INVALID_ARGUMENT:
      throw Error("", "ray scene", doing + ": invalid argument");
    case RTC_ERROR_INVALID_OPERATION:
      throw Error("", "ray scene", doing + ": invalid operation");
    case RTC_ERROR_CANCELLED:
      throw Cancelled("", "ray scene", doing + ": cancelled");
    default:
      throw Error("", "ray scene", doing + ": unknown failure in Embree");
  }
}

}  // namespace catoptra::optics
