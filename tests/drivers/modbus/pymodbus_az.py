"""An Oriental Motor AZ as far as a settled move needs it, on pymodbus' server: a peer that is not fvd's.

Prints the port it listens on, then serves until it is ended. Moves arrive at once.
"""

import asyncio

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server.async_io import ModbusTcpServer

TARGET, TRIGGER, AUTO_OFF, OUTPUT, POSITION = 0x5C, 0x66, 0x78, 0x7E, 0xCC
HOME_END, READY, IN_POSITION = 1 << 4, 1 << 5, 1 << 14


class Drive(ModbusSequentialDataBlock):
    """Registers 0..0x3FF; pymodbus counts them from 1."""

    def __init__(self):
        super().__init__(1, [0] * 0x400)
        self.put(OUTPUT + 1, READY | IN_POSITION)

    def put(self, register, value):
        super().setValues(register + 1, [value])

    def get(self, register):
        return self.getValues(register + 1, 1)[0]

    def setValues(self, address, values):
        super().setValues(address, values)
        if self.get(AUTO_OFF + 1) & (1 << 4):
            self.put(AUTO_OFF + 1, 0)
            self.put(POSITION, 0)
            self.put(POSITION + 1, 0)
            self.put(OUTPUT + 1, HOME_END | READY | IN_POSITION)
        if self.get(TRIGGER + 1) == 1:
            self.put(TRIGGER + 1, 0)
            self.put(POSITION, self.get(TARGET))
            self.put(POSITION + 1, self.get(TARGET + 1))


async def main():
    context = ModbusServerContext(slaves={1: ModbusSlaveContext(hr=Drive())}, single=False)
    server = ModbusTcpServer(context, address=("127.0.0.1", 0))
    serving = asyncio.create_task(server.serve_forever())
    await server.serving
    print(server.server.sockets[0].getsockname()[1], flush=True)
    await serving


asyncio.run(main())
