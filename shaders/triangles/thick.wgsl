// Color and opacity are found at the thick vertex and linear on the screen over each triangle, 0 on the outline: the integration that is
// defined on fans ([Shirley 1990], section 2.6).
//
// Attributes: color and opacity; where color is not what opacity multiplies, light and opacity.

#use cell/cell.wgsl
#use integrate/light.wgsl
#use triangles/fan.wgsl
#use triangles/screen.wgsl
#use integrate/pieces.wgsl
#use <model>

const HAS_COLOR: bool = MODEL_EMITS && !MODEL_COLOR_IS_PER_LENGTH;

fn light_at(corners: Corners, at: FanVertex) -> vec4<f32> {
    let low = lowest(corners.scalars);
    let high = highest(corners.scalars);
    let found = find_pieces(corners.scalar, low, high);
    let cell = Optics(corners.scalar, low, high, found.x, found.y);
    if at.difference == 0.0 {
        // A corner of the outline: nothing between the ends.
        var color = vec3<f32>();
        if HAS_COLOR {
            color = transfer_at(cell, scalar_of(at.front, at.nearness)).color;
        }
        return vec4<f32>(color, 0.0);
    }
    let leave = at.nearness - at.difference;
    let front = transfer_at(cell, scalar_of(at.front, at.nearness));
    let back = transfer_at(cell, scalar_of(at.back, leave));
    let extinction = 0.5 * (front.extinction + back.extinction);
    let color = 0.5 * (front.color + back.color);
    var chord = at.difference;
    if frame.is_perspective != 0u {
        chord = corners.depth * at.difference / ((1.0 + at.nearness) * (1.0 + leave));
    }
    let center = screen_place(at.point, at.beside) + pixel_center(vec2<i32>(frame.columns.x, frame.rows.x));
    let light = model_constant(extinction, color, chord * ray_stretch(center));
    return vec4<f32>(select(light.rgb, color, HAS_COLOR), light.opacity);
}

// The scalar itself.
fn scalar_of(over: f32, nearness: f32) -> f32 {
    return select(over, over / (1.0 + nearness), frame.is_perspective != 0u);
}

fn fan_light(attributes: vec4<f32>) -> Light {
    let opacity = clamp(attributes.a, 0.0, 1.0);
    let color = max(attributes.rgb, vec3<f32>());
    return Light(select(color, color * opacity, HAS_COLOR), opacity);
}
