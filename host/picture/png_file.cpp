#include "host/picture/png_file.h"

#include <png.h>

#include <stdexcept>

namespace emax {

std::string png_bytes(std::span<const Colour> pixels, std::uint32_t width, std::uint32_t height) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);  // at most
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::string("libpng cannot write a picture: ") + image.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace emax
