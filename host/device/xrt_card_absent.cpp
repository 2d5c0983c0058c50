#include "host/device/xrt_device.h"
#include "sw_model/base/error.h"

namespace emax {

std::unique_ptr<CardMovers> open_xrt_card(std::string_view address) {
  throw Error("device xrt:" + std::string(address) +
              ": this emax was built without XRT; install libxrt-dev and build with "
              "cmake -DEMAX_XRT=ON");
}

}  // namespace emax
