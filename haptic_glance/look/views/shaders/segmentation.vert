#version 330 core

layout(location = 0) in vec3 position;
layout(location = NORMAL_LOC) in vec3 normal;
layout(location = COLOR_0_LOC) in vec4 color_0;
layout(location = INST_M_LOC) in mat4 inst_m;

uniform mat4 P;
uniform mat4 V;
uniform mat4 M;

out vec3 view_normal;
out vec3 albedo;

void main()
{
    mat4 to_view = V * M * inst_m;
    gl_Position = P * to_view * vec4(position, 1.0);
    view_normal = mat3(to_view) * normal;
    albedo = color_0.rgb;
}
