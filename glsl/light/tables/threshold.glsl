// What the square of the difference over its variance is in the mean where both boxes are equally wrong: 1 by
// noise, and the bias of the wider one, which grows with the square of the radius, so that the difference to
// the narrower one is known from its own. The rule of Rousselle, Knaus and Zwicker 2011.
float threshold(float fine, float coarse)
{
    float a = (fine + 0.5) * (fine + 0.5);
    float b = (coarse + 0.5) * (coarse + 0.5);
    return 1.0 + (b - a) / (b + a);
}
