#!/usr/bin/env lua5.2
-- SPDX-License-Identifier: BSD-3-Clause
-- The newest map in an LCM log, a line a plane, in Lua 5.2 with Debian's liblcm-lua.
--
--   lcm-gen -l --lpath types /usr/share/planemap/lcmtypes/*.lcm      # or lcmtypes/*.lcm of a checkout
--   LUA_PATH='types/?.lua;types/?/init.lua' examples/05_read_a_log.lua out/office/plane_map.lcmlog
local planemap = require('planemap')

local labels = {}
for name, value in pairs(planemap.map_plane_t) do
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

local newest
each_event(assert(arg[1], 'usage: 05_read_a_log.lua LOG'), function(channel, data)
  if channel == 'PLANEMAP_MAP' then newest = planemap.plane_map_t.decode(data) end
end)
assert(newest, arg[1] .. ': holds no map')
for _, plane in ipairs(newest.planes) do
  print(string.format('%d %s normal %.4f %.4f %.4f d %.4f area %.2f', plane.id, labels[plane.label], plane.normal[1],
                      plane.normal[2], plane.normal[3], plane.d, plane.area))
end
