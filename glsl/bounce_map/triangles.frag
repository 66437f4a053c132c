// Which triangle is nearest to the light, from 1 (thesis 2.6.1).
flat in float number;

layout(location = 0) out uint primitive;

void main()
{
    primitive = uint(number + 0.5);
}
