/* The module that image_file.c loads: OpenImageIO behind a C interface, the only C++ of pscn. No exception leaves
 * it. */
extern "C" {
#include "image/image_module.h"
}

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <vector>

namespace
{

using Bytes = std::vector<unsigned char>;

/* What ends the work early. `text` is empty if the message is written already. */
struct failure {
  status result;
  std::string text;
};

void say(char *message, const std::string &text)
{
  const std::size_t end = text.find_first_of("\r\n");
  std::snprintf(message, IMAGE_MESSAGE_SIZE, "%s", text.substr(0, end).c_str());
}

OIIO::TypeDesc channel_type(const image_encoding &encoding, const image_channel &channel)
{
  return encoding.bits == 16 && !channel.data ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;
}

OIIO::ImageSpec make_spec(const image &picture, const image_encoding &encoding)
{
  OIIO::ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                       static_cast<int>(picture.channel_count), channel_type(encoding, picture.channel[0]));
  if (picture.full_width != 0) {
    spec.x = static_cast<int>(picture.x);
    spec.y = static_cast<int>(picture.y);
    spec.full_width = static_cast<int>(picture.full_width);
    spec.full_height = static_cast<int>(picture.full_height);
  }
  if (encoding.tile != 0) {
    spec.tile_width = spec.tile_height = encoding.tile;
    spec.attribute("compression", "rle");
  }
  bool mixed = false;
  for (std::size_t c = 0; c < picture.channel_count; c++) {
    spec.channelnames[c] = picture.channel[c].name;
    spec.channelformats.push_back(channel_type(encoding, picture.channel[c]));
    mixed = mixed || spec.channelformats[c] != spec.format;
  }
  if (!mixed) spec.channelformats.clear();
  spec.attribute("oiio:ColorSpace", "Linear");
  for (const char *name = nullptr; (name = image_next_text(&picture, name)) != nullptr;)
    spec.attribute(name, name + std::strlen(name) + 1);
  return spec;
}

/* Writes all rows, some at a time, so that their converted values take little memory, and the caller can follow and stop
 * it. */
void write_rows(OIIO::ImageOutput &output, const OIIO::ImageSpec &spec, const image &picture,
                const image_encoding &encoding)
{
  /* Whole blocks of every EXR compression, or one row of tiles. */
  const std::size_t most = encoding.tile == 0 ? 64 : static_cast<std::size_t>(encoding.tile);
  for (std::size_t row = 0; row < picture.height; row += most) {
    const std::size_t rows = std::min(most, picture.height - row);
    const float *pixels = picture.value + row * picture.width * picture.channel_count;
    const int y = spec.y + static_cast<int>(row), end = y + static_cast<int>(rows);
    if (!(encoding.tile == 0
            ? output.write_scanlines(y, end, 0, OIIO::TypeDesc::FLOAT, pixels)
            : output.write_tiles(spec.x, spec.x + spec.width, y, end, 0, 1, OIIO::TypeDesc::FLOAT, pixels)))
      throw failure{STATUS_FILE, "OpenImageIO: " + output.geterror()};
    const double part = static_cast<double>(row + rows) / static_cast<double>(picture.height);
    if (encoding.progress != nullptr && !encoding.progress(encoding.context, part))
      throw failure{STATUS_INTERRUPTED, "interrupted"};
  }
}

Bytes encode(const image &picture, const image_encoding &encoding)
{
  Bytes file;
  const OIIO::ImageSpec spec = make_spec(picture, encoding);
  OIIO::Filesystem::IOVecOutput proxy(file); /* outlives the output, whose destructor still writes into it */
  std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("exr");
  if (!output) throw failure{STATUS_FILE, "OpenImageIO: " + OIIO::geterror()};
  if (!output->supports("ioproxy")) throw failure{STATUS_FILE, "this OpenImageIO cannot write the format to memory"};
  /* The name only selects the format; the bytes go to the proxy. */
  if (!output->set_ioproxy(&proxy) || !output->open("memory.exr", spec))
    throw failure{STATUS_FILE, "OpenImageIO: " + output->geterror()};
  write_rows(*output, spec, picture, encoding);
  if (!output->close()) throw failure{STATUS_FILE, "OpenImageIO: " + output->geterror()};
  if (file.empty()) throw failure{STATUS_FILE, "OpenImageIO wrote nothing"};
  return file;
}

/* Reads the picture's place in a larger one. A picture that is not inside of one counts as a whole. */
void read_window(const OIIO::ImageSpec &spec, image &out)
{
  const long long x = static_cast<long long>(spec.x) - spec.full_x, y = static_cast<long long>(spec.y) - spec.full_y;
  if (x < 0 || y < 0 || x + spec.width > spec.full_width || y + spec.height > spec.full_height) return;
  out.x = static_cast<std::size_t>(x);
  out.y = static_cast<std::size_t>(y);
  out.full_width = static_cast<std::size_t>(spec.full_width);
  out.full_height = static_cast<std::size_t>(spec.full_height);
}

void read_metadata(const OIIO::ImageSpec &spec, image &out)
{
  for (const auto &attribute : spec.extra_attribs)
    if (attribute.name().string().rfind("pscn:", 0) == 0 && attribute.type() == OIIO::TypeDesc::STRING &&
        !image_add_text(&out, attribute.name().c_str(), "%s", attribute.get_string().c_str()))
      throw std::bad_alloc();
}

/* Checks that what is read will be all that the file has. */
void check_whole(OIIO::ImageInput &input, const OIIO::ImageSpec &spec)
{
  if (spec.width <= 0 || spec.height <= 0 || spec.depth > 1 || spec.nchannels <= 0 ||
      spec.nchannels > IMAGE_MAX_CHANNELS)
    throw failure{STATUS_FILE, "not a flat picture of at most " + std::to_string(IMAGE_MAX_CHANNELS) + " channels"};
  for (const std::string &name : spec.channelnames)
    if (name.size() >= IMAGE_NAME_SIZE)
      throw failure{STATUS_FILE, "a channel has a name of more than " + std::to_string(IMAGE_NAME_SIZE - 1) + " bytes"};
  /* In YCbCr, pixels may share a value of colour, and a row then has fewer bytes, as stored, than OpenImageIO takes for
   * pixels: it would read beyond them in memory. */
  if (spec.get_string_attribute("tiff:ColorSpace") == "YCbCr")
    throw failure{STATUS_FILE, "its colours are YCbCr, not red, green and blue"};
  if (input.seek_subimage(1, 0)) throw failure{STATUS_FILE, "it has several pictures"};
  (void)input.geterror(); /* discards the error that there is no other picture */
  if (!input.seek_subimage(0, 0)) throw failure{STATUS_FILE, input.geterror()};
}

/* Reads all pixels. A TIFF is read row by row or tile by tile: if OpenImageIO takes many rows or tiles at once, it
 * unpacks them itself, and does not report those that it cannot unpack: other contents of memory would be read. */
bool read_pixels(OIIO::ImageInput &input, const OIIO::ImageSpec &spec, image &out)
{
  OIIO::attribute("tiff:multithread", 0);
  if (spec.tile_width != 0 || std::strcmp(input.format_name(), "tiff") != 0)
    return input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, out.value);
  for (std::size_t row = 0; row < out.height; row++)
    if (!input.read_scanline(spec.y + static_cast<int>(row), 0, OIIO::TypeDesc::FLOAT,
                             out.value + row * out.width * out.channel_count))
      return false;
  return true;
}

/* The whole tiles that contain an area, relative to the first pixel of `out`. */
rectangle tiles_of(const OIIO::ImageSpec &spec, const image &out, const rectangle &area)
{
  const auto width = static_cast<std::size_t>(spec.tile_width), height = static_cast<std::size_t>(spec.tile_height);
  const std::size_t x = (area.x - out.x) / width * width, y = (area.y - out.y) / height * height;
  const std::size_t right = (area.x - out.x + area.width + width - 1) / width * width;
  const std::size_t below = (area.y - out.y + area.height + height - 1) / height * height;
  return {x, y, std::min(right, out.width) - x, std::min(below, out.height) - y};
}

/* Reads the pixels of an area, through whole tiles. */
bool read_area(OIIO::ImageInput &input, const OIIO::ImageSpec &spec, const rectangle &area, std::vector<float> &room,
               image &out)
{
  const rectangle tiles = tiles_of(spec, out, area);
  const int left = spec.x + static_cast<int>(tiles.x), top = spec.y + static_cast<int>(tiles.y);
  room.resize(tiles.width * tiles.height * out.channel_count);
  if (!input.read_tiles(0, 0, left, left + static_cast<int>(tiles.width), top, top + static_cast<int>(tiles.height), 0,
                        1, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, room.data()))
    return false;
  const std::size_t x = area.x - out.x;
  for (std::size_t y = area.y - out.y; y < area.y - out.y + area.height; y++) {
    const float *from = room.data() + ((y - tiles.y) * tiles.width + x - tiles.x) * out.channel_count;
    std::copy(from, from + area.width * out.channel_count, image_pixel(&out, x, y));
  }
  return true;
}

/* Reads only the areas if their tiles have fewer pixels than the picture, otherwise all of it. */
bool read_areas(OIIO::ImageInput &input, const OIIO::ImageSpec &spec, const rectangle *area, std::size_t count,
                image &out)
{
  if (spec.tile_width <= 0 || spec.tile_height <= 0) return read_pixels(input, spec, out);
  std::size_t left = out.width * out.height; /* counted down, so that no sum overflows */
  for (std::size_t k = 0; k < count; k++) {
    const rectangle tiles = tiles_of(spec, out, area[k]);
    left -= std::min(left, tiles.width * tiles.height);
  }
  if (left == 0) return read_pixels(input, spec, out);
  std::vector<float> room;
  for (std::size_t k = 0; k < count; k++)
    if (!read_area(input, spec, area[k], room, out)) return false;
  return true;
}

void read(const char *path, const char *format, const image_wanted *wanted, image &out, char *message)
{
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
  if (!input) throw failure{STATUS_FILE, "OpenImageIO: " + OIIO::geterror()};
  OIIO::ImageSpec spec, as_stored; /* neither multiplied by opacity nor converted to red, green and blue */
  as_stored.attribute("oiio:UnassociatedAlpha", 1);
  as_stored.attribute("oiio:RawColor", 1);
  if (!input->open(path, spec, as_stored)) throw failure{STATUS_FILE, input->geterror()};
  check_whole(*input, spec);
  const failure too_large{STATUS_LIMIT, "there is too little memory for its pixels, or they are too many"};
  if (image_create_header(static_cast<std::size_t>(spec.width), static_cast<std::size_t>(spec.height),
                          static_cast<std::size_t>(spec.nchannels), &out) != STATUS_OK)
    throw too_large;
  for (std::size_t c = 0; c < out.channel_count; c++)
    std::snprintf(out.channel[c].name, IMAGE_NAME_SIZE, "%s", spec.channelnames[c].c_str());
  read_window(spec, out);
  read_metadata(spec, out);
  const rectangle *area = nullptr;
  std::size_t areas = 0;
  const status asked = wanted == nullptr ? STATUS_OK : wanted->areas(wanted->context, &out, &area, &areas, message);
  if (asked != STATUS_OK) throw failure{asked, ""};
  if (wanted != nullptr && areas == 0) return;
  if (image_add_pixels(&out) != STATUS_OK) throw too_large;
  /* Rows of a TIFF or JPEG that is cut off or damaged are made up. geterror() tells that, the returned value does
   * not. */
  const bool done = wanted == nullptr ? read_pixels(*input, spec, out) : read_areas(*input, spec, area, areas, out);
  const std::string problem = input->geterror();
  if (!done || !problem.empty()) throw failure{STATUS_FILE, problem};
}

/* Runs work(), and converts exceptions to a status and a message. */
template <typename Work> status guarded(char *message, Work work)
{
  try {
    work();
    return STATUS_OK;
  } catch (const failure &problem) {
    if (!problem.text.empty()) say(message, problem.text);
    return problem.result;
  } catch (const std::bad_alloc &) {
    say(message, "out of memory");
    return STATUS_LIMIT;
  } catch (const std::system_error &problem) { /* no room for a thread of OpenEXR or OpenImageIO */
    const bool limit = problem.code() == std::errc::resource_unavailable_try_again ||
                       problem.code() == std::errc::not_enough_memory;
    say(message, limit ? "out of memory or threads" : problem.what());
    return limit ? STATUS_LIMIT : STATUS_FILE;
  } catch (const std::exception &problem) {
    say(message, problem.what());
    return STATUS_FILE;
  }
}

status module_encode(const image *picture, const image_encoding *encoding, unsigned char **out_bytes,
                     std::size_t *out_size, char *message)
{
  return guarded(
    message,
    [&] {
      const Bytes file = encode(*picture, *encoding);
      *out_bytes = static_cast<unsigned char *>(std::malloc(file.size()));
      if (*out_bytes == nullptr) throw std::bad_alloc();
      std::memcpy(*out_bytes, file.data(), file.size());
      *out_size = file.size();
    });
}

status module_read(const char *path, const char *format, const image_wanted *wanted, image *out, char *message)
{
  const status result = guarded(message, [&] { read(path, format, wanted, *out, message); });
  if (result != STATUS_OK) image_destroy(out);
  return result;
}

/* The first user of an EXR writer or reader starts OpenEXR's threads. If they cannot be started, OpenImageIO silently
 * gives no writer. That must not be found out only when a picture is done. */
status module_begin(char *message)
{
  return guarded(
    message,
    [&] {
      if (OIIO::ImageOutput::create("exr")) return;
      const std::string problem = OIIO::geterror();
      if (problem.empty()) throw failure{STATUS_LIMIT, "there are too few threads"};
      throw failure{STATUS_FILE, "OpenImageIO: " + problem};
    });
}

} // namespace

extern "C" const struct image_module image_module = {sizeof(struct image), sizeof(struct image_encoding), module_begin,
                                                     module_encode, module_read};
