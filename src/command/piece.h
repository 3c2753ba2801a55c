/* Parts of a picture, which say of themselves what they are part of.
 *
 * A part is an EXR of floats with the window of the picture it belongs to, the pixels of the tiles it has, 0 elsewhere,
 * and texts that say what was rendered, how, which tiles these are, and a sum of it all. It is packed in tiles as large as
 * a rendering's, so that those that a part has can be read without the others; one in rows is read, too. There is no other
 * form: pieces of a farm (`render --tile`), what an interrupted rendering leaves behind and `--resume` goes on with, and
 * what `merge` reads.
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
  struct tile_list tiles; /* of this piece; done: those the image has */
};

/* "K/N", 1 <= K <= N. */
bool piece_number(const char *text, size_t length, size_t *out_number, size_t *out_count);

/* A black picture of the crop with its channels, of which nothing is done. The metadata of its image is made of the
 * attributes whose names begin with "pscn:". The caller destroys it, also a zero one. */
enum status piece_create(const struct render_options *options, size_t number, size_t count,
                         const struct image_attribute *attributes, size_t attribute_count,
                         struct piece *out) STATUS_MUST_CHECK;
/* The same of the picture that `piece` is of, without metadata. */
enum status piece_create_like(const struct piece *piece, size_t number, size_t count,
                              struct piece *out) STATUS_MUST_CHECK;
void piece_destroy(struct piece *piece);

/* Reads a part, of whose image the pixels of its tiles count, or only what it says of itself. STATUS_FILE, STATUS_LIMIT;
 * STATUS_INPUT where the file is a picture, but no part that can be understood. Then *out is zero and
 * message[IMAGE_MESSAGE_SIZE] says why. */
enum status piece_read(const char *path, bool pixels, struct piece *out, char *message) STATUS_MUST_CHECK;

/* Whether both are parts of one picture, by what they say; else `out` says what parts them. */
bool piece_belongs(const struct image *part, const struct image *picture, char *out, size_t size);

/* Copies the tiles that `from` has, which stands where `to` does; the channels are found by their names. False where one
 * is missing. */
bool piece_copy(const struct piece *from, struct image *to);

/* The bytes of the file of a part that has the tiles of the piece that are done, described by the attributes; to be freed. May be
 * called while others are rendered: it has those that were done when it began. */
enum status piece_encode(const struct piece *piece, const struct image_attribute *attributes, size_t attribute_count,
                         unsigned char **out_bytes, size_t *out_size, char *message) STATUS_MUST_CHECK;

#endif
