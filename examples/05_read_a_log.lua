#!/usr/bin/env lua5.2
-- SPDX-License-Identifier: BSD-3-Clause
-- The newest map in an LCM log, a line a plane, in Lua 5.2 with Debian's liblcm-lua.
--
--   lcm-gen -l --lpath types /usr/share/planemap/lcmtypes/*.lcm      # or lcmtypes/*.lcm of a checkout
--   LUA_PATH='types/?.lua;types/?/init.lua' examples/05_read_a_log.lua out/office/plane_map.lcmlog
local planemap = require('planemap')

local labels = {}
for name, value in pairs(planemap.plane_map_t) do
  local label = type(name) == 'string' and name:match('^LABEL_(.+)')
  if label then labels[value] = label:lower() end
end

local function u32(bytes, at)
  local a, b, c, d = bytes:byte(at, at + 3)
  return ((a * 256 + b) * 256 + c) * 256 + d
end

-- Calls handle(channel, bytes) for each event.
local function each_event(path, handle)
  local log = assert(io.open(path, 'rb'))
  while true do
    local header = log:read(28)
    if not header then break end
    assert(#header == 28, path .. ': is cut short')
    assert(u32(header, 1) == 0xEDA1DA01, path .. ': is no LCM log, or a damaged one')
    local channel, data = log:read(u32(header, 21)), log:read(u32(header, 25))
    assert(data and #data == u32(header, 25), path .. ': is cut short')
    handle(channel, data)
  end
  log:close()
end

-- What plane_map_t.packed holds: seven bits a byte, the lowest first, the eighth says that more follow.
local function numbers(bytes)
  local at = 0
  local function number()
    local value, factor = 0, 1
    repeat
      at = at + 1
      local byte = assert(bytes[at], 'the map is cut short')
      value, factor = value + byte % 128 * factor, factor * 128
    until byte < 128
    return value
  end
  local function signed()
    local n = number()
    return n % 2 == 0 and n / 2 or -(n + 1) / 2
  end
  return number, signed
end

-- The planes of a plane_map_t, as docs/formats.md has them; rings in metres in the plane, from its point nearest to the
-- world's origin. Lines, points and inferred parts follow them.
local function unpacked(message)
  local number, signed = numbers(message.packed)
  local planes, id = {}, -1
  for i = 1, number() do
    id = id + 1 + signed()
    local plane = {id = id, label = number(), rings = {}}
    local x, y = signed() / 65536, signed() / 65536
    local z = 1 - math.abs(x) - math.abs(y)
    if z < 0 then
      x, y = (1 - math.abs(y)) * (x < 0 and -1 or 1), (1 - math.abs(x)) * (y < 0 and -1 or 1)
    end
    local length = math.sqrt(x * x + y * y + z * z)
    plane.normal = {x / length, y / length, z / length}
    plane.d, plane.angle = signed() * 0.0005, signed() * math.pi / 8192
    local rms, inliers, keyframes = number() * 0.0001, number(), number()
    plane.rms, plane.inliers, plane.keyframes = rms, inliers % 512 * 2 ^ math.floor(inliers / 512), keyframes
    local u, v = 0, 0
    for r = 1, number() do
      local ring = {}
      for k = 1, number() do
        u, v = u + signed(), v + signed()
        ring[k] = {u * message.unit, v * message.unit}
      end
      plane.rings[r] = ring
    end
    planes[i] = plane
  end
  return planes
end

-- Holes run the other way round.
local function area(rings)
  local sum = 0
  for _, ring in ipairs(rings) do
    for k, a in ipairs(ring) do
      local b = ring[k % #ring + 1]
      sum = sum + a[1] * b[2] - b[1] * a[2]
    end
  end
  return math.abs(sum) / 2
end

local newest
each_event(assert(arg[1], 'usage: 05_read_a_log.lua LOG'), function(channel, data)
  if channel == 'PLANEMAP_MAP' then newest = planemap.plane_map_t.decode(data) end
end)
assert(newest, arg[1] .. ': holds no map')
for _, plane in ipairs(unpacked(newest)) do
  print(string.format('%d %s normal %.4f %.4f %.4f d %.4f area %.2f', plane.id, labels[plane.label], plane.normal[1],
                      plane.normal[2], plane.normal[3], plane.d, area(plane.rings)))
end
