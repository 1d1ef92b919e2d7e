#version 330 core

in vec3 view_normal;
in vec3 albedo;

uniform vec3 color;  // white: draw face ids, from 1 on; black: draw the material

out vec4 frag_color;

void main()
{
    if (color.r > 0.5) {
        int number = gl_PrimitiveID + 1;
        frag_color = vec4(vec3(number & 255, (number >> 8) & 255, (number >> 16) & 255) / 255.0, 1.0);
    } else {
        // The head light is on the view axis, at infinity: the cosine is the z component of the normal.
        float cosine = max(view_normal.z / max(length(view_normal), 1e-30), 0.0);
        float highlight = SPECULAR > 0.0 ? SPECULAR * pow(cosine, SHININESS) : 0.0;
        frag_color = vec4(albedo * (AMBIENT + DIFFUSE * cosine) + highlight, 1.0);
    }
}
