/* What the C programs of tests/capi share: expectations that count, and textures. */
#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>
#include <string.h>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include "headless.h"
#include "varikernel.h"

static int failures = 0;

/* Whether a status is the expected one and the text names `word`. */
static int is_expected(varikernel_status got, varikernel_status expected, const char *word) {
    return got == expected && (got == VARIKERNEL_STATUS_OK || strstr(varikernel_last_error(), word) != NULL);
}

#define EXPECT(call, status, word)                                                                     \
    do {                                                                                               \
        varikernel_status got = (call);                                                                \
        if (!is_expected(got, status, word)) {                                                         \
            printf("line %d: status %d, \"%s\"\n", __LINE__, (int)got, varikernel_last_error());       \
            failures++;                                                                                \
        }                                                                                              \
    } while (0)

#define EXPECT_OK(call) EXPECT(call, VARIKERNEL_STATUS_OK, "")

#define EXPECT_TRUE(condition)                                   \
    do {                                                         \
        if (!(condition)) {                                      \
            printf("line %d: not " #condition "\n", __LINE__);   \
            failures++;                                          \
        }                                                        \
    } while (0)

/* Gives a texture other 8-bit integers, and leaves the state of OpenGL at its defaults. */
static inline void put_bytes(GLuint texture, int width, int height, const unsigned char *texels) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8UI, width, height, 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, texels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_2D, 0);
}

/* A texture of 8-bit integers. */
static inline GLuint texture_of_bytes(int width, int height, const unsigned char *texels) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    put_bytes(texture, width, height, texels);
    return texture;
}

#endif
