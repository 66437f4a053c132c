// Sets every pixel that gets here: the depth or stencil test has let it through.

// 1; others stay as cleared.
layout(location = 0) out uint passed;

void main()
{
    passed = 1u;
}
