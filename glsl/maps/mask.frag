// Sets every pixel that passes the depth or stencil test.

// 1; others stay as cleared.
layout(location = 0) out uint passed;

void main()
{
    passed = 1u;
}
