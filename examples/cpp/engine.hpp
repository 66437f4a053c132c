// What an engine has of its own, beside varikernel: programs, textures, photons on a floor.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include "varikernel.h"

// Ends the program with a message if something does not hold.
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

// A GL_RGBA32F texture with these texels, or a GL_R32F one to draw to.
struct Texture {
    GLuint name = 0;
    Texture(int width, int height, const float *rgba = nullptr) {
        glGenTextures(1, &name);
        glBindTexture(GL_TEXTURE_2D, name);
        glTexImage2D(GL_TEXTURE_2D, 0, rgba ? GL_RGBA32F : GL_R32F, width, height, 0, rgba ? GL_RGBA : GL_RED, GL_FLOAT, rgba);
    }
    ~Texture() { glDeleteTextures(1, &name); }
    Texture(const Texture &) = delete;
};

// A framebuffer around any texture.
struct Target {
    int width, height;
    GLuint framebuffer = 0;
    Target(GLuint texture, int width, int height) : width(width), height(height) {
        glGenFramebuffers(1, &framebuffer);
        begin();
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    }
    ~Target() { glDeleteFramebuffers(1, &framebuffer); }
    Target(const Target &) = delete;
    void begin() const {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        glViewport(0, 0, width, height);
    }
    // The red values.
    std::vector<float> read() const {
        std::vector<float> values(static_cast<size_t>(width) * height);
        begin();
        glReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, values.data());
        return values;
    }
};

// Photons on a floor 2 units below the camera, which looks down on it: a caustic in the middle, dim light
// around. Together they carry a power of 1, and all of them land in the picture.
inline std::vector<varikernel_photon> photons_on_a_floor(int count) {
    std::mt19937 random(1);
    std::normal_distribution<float> caustic(0.0f, 0.2f);
    std::uniform_real_distribution<float> across(-2.4f, 2.4f), along(-1.8f, 1.8f);
    std::vector<varikernel_photon> photons;
    for (int i = 0; i < count; i++) {
        const float x = i % 2 ? caustic(random) : across(random), y = i % 2 ? caustic(random) : along(random);
        const float power = 1.0f / static_cast<float>(count);
        photons.push_back({{x, y, -2}, {0, 0, 1}, {power, power, power}, 1});
    }
    return photons;
}

// The engine's camera: 90 degrees tall, from 1 to 3 units; and what it sees of the floor: places with their
// depth, normals with the number of the surface. An engine draws these.
struct Floor {
    float view[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    float projection[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -2, -1, 0, 0, -3, 0};
    std::vector<float> positions, normals;
    Floor(int width, int height) {
        projection[0] = static_cast<float>(height) / static_cast<float>(width);
        const float side = 4.0f / static_cast<float>(height);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const float right = (static_cast<float>(x) + 0.5f) * side - 2.0f / projection[0];
                positions.insert(positions.end(), {right, (static_cast<float>(y) + 0.5f) * side - 2.0f, -2, 2});
                normals.insert(normals.end(), {0, 0, 1, 1});
            }
    }
};
