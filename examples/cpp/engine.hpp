// What an engine has of its own, beside varikernel: programs and textures to draw to.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

// Ends the program with words if something does not hold.
inline void require(bool holds, const std::string &what) {
    if (!holds) {
        std::fprintf(stderr, "failed: %s\n", what.c_str());
        std::exit(1);
    }
}

inline GLuint program(const char *vertex, const char *fragment) {
    const GLuint program = glCreateProgram();
    for (const auto &[kind, source] : {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
        const GLuint shader = glCreateShader(kind);
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    require(linked, "compiling the engine's shaders");
    return program;
}

// A texture of the engine with a framebuffer around it.
struct Target {
    int width, height;
    GLuint texture = 0, framebuffer = 0;
    Target(int width, int height) : width(width), height(height) {
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, width, height, 0, GL_RED, GL_FLOAT, nullptr);
        glGenFramebuffers(1, &framebuffer);
        begin();
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    }
    ~Target() {
        glDeleteFramebuffers(1, &framebuffer);
        glDeleteTextures(1, &texture);
    }
    Target(const Target &) = delete;
    void begin() const {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        glViewport(0, 0, width, height);
    }
    std::vector<float> read() const {
        std::vector<float> values(static_cast<size_t>(width) * height);
        begin();
        glReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, values.data());
        return values;
    }
};
