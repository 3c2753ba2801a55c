/* Parts of a picture, each of which says which picture it belongs to.
 *
 * A part is an EXR of floats. It has the window of the picture it belongs to, the pixels of its own tiles, and 0
 * elsewhere. Its metadata say what was rendered and how, which tiles it has, and a checksum. It is packed in tiles of
 * the renderer's size, so that its own tiles can be read without the others; a part packed in rows is readable too. The
 * same form serves for the pieces of a farm (`render --tile`), for what an interrupted rendering leaves for `--resume`,
 * and as the input of `merge`.
 */
#ifndef PSCN_COMMAND_PIECE_H
#define PSCN_COMMAND_PIECE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "image/image_file.h"
#include "render/render.h"

/* Piece `number` of `count`, from 1; a whole picture is 1 of 1. */
struct piece {
  struct image image;
  size_t number, count;
  struct channel_list channels;
  struct tile_list tiles; /* those of this piece; rows: what the image has of them */
};

enum { PIECE_MOST = 1000000 }; /* pieces of a picture */

/* Makes a black picture of the crop with its channels and without metadata, in which no tile is done. The caller
 * destroys it, even on failure, and may destroy a zero one. */
enum status piece_create(const struct render_options *options, size_t number, size_t count,
                         struct piece *out) STATUS_MUST_CHECK;
/* The same for the picture that `piece` belongs to. */
enum status piece_create_like(const struct piece *piece, size_t number, size_t count,
                              struct piece *out) STATUS_MUST_CHECK;
void piece_destroy(struct piece *piece);

/* Reads a part: with `pixels`, the pixels of its tiles count; otherwise only its metadata are read. Returns
 * STATUS_FILE, STATUS_LIMIT, or STATUS_INPUT if the file is a picture but not a valid part; then *out is zero and
 * message[IMAGE_MESSAGE_SIZE] says why. */
enum status piece_read(const char *path, bool pixels, struct piece *out, char *message) STATUS_MUST_CHECK;

/* Whether a part belongs to the picture, by their metadata. If not, `out` says how they differ. */
bool piece_belongs(const struct image *part, const struct image *picture, char *out, size_t size);

/* Copies what `from` has of its tiles into `to`, whose window is the same. Channels are matched by name; returns false if
 * one is missing. */
bool piece_copy(const struct piece *from, struct image *to);

/* image_next_text of the lines that describe the whole picture. */
const char *piece_next_text(const struct image *part, const char *name);

/* Encodes a part: what is done of the piece, with the metadata of its image. The caller frees the bytes. May be called
 * while the rest is being rendered: it has what was done when it began. */
enum status piece_encode(const struct piece *piece, unsigned char **out_bytes, size_t *out_size,
                         char *message) STATUS_MUST_CHECK;

#endif
