# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The notifications of a Bluetooth device as bytes at a TCP port, for every program (pip install bleak).

bridge.py ADDRESS CHARACTERISTIC [PORT]
dermis record --from 'tcp://127.0.0.1:7000?layout=mat.toml' --out mat.mcap"""

import asyncio
import sys

from bleak import BleakClient


async def bridge(address, characteristic, port="7000"):
    async def serve(_, writer):
        async with BleakClient(address, disconnected_callback=lambda _: writer.close()) as client:
            await client.start_notify(characteristic, lambda _, data: writer.write(bytes(data)))
            await writer.wait_closed()

    server = await asyncio.start_server(serve, "127.0.0.1", int(port))
    print(f"listens at tcp://127.0.0.1:{server.sockets[0].getsockname()[1]}", flush=True)
    await server.serve_forever()


if __name__ == "__main__":
    asyncio.run(bridge(*sys.argv[1:]))
