// modbus-serial as a client of a simulated CiA 402 drive: node client.js PORT. Prints what it saw, one fact a line.
"use strict";

const ModbusRTU = require("modbus-serial");

const CONTROL = 6000;
const TARGET = 6002;
const SPEED = 6004;
const ACCELERATION = 6009;
const STATUS = 5000;
const POSITION = 5002;
const MODE = 6001;

const pair = (number) => [number >>> 16, number & 0xffff];
const client = new ModbusRTU();

async function until(what, holds) {
  const deadline_ms = performance.now() + 20000;
  while (performance.now() < deadline_ms) {
    const words = (await client.readInputRegisters(STATUS, 4)).buffer;
    if (holds(words.readUInt16BE(0), words.readInt32BE(2 * (POSITION - STATUS)))) return;
  }
  throw new Error(`the drive is not ${what} within 20 s`);
}

async function refusal(request) {
  try {
    await request;
  } catch (error) {
    return error.modbusCode;
  }
  return 0;
}

async function main() {
  await client.connectTCP("127.0.0.1", { port: Number(process.argv[2]) });
  client.setID(1);
  client.setTimeout(10000);
  const identity = await client.readDeviceIdentification(1, 0);
  console.log("identity", Object.values(identity.data).join(", "));
  console.log("no such register", await refusal(client.readHoldingRegisters(100, 1)));
  console.log("no such coil", await refusal(client.readCoils(0, 1)));
  console.log("no such object", await refusal(client.readDeviceIdentification(4, 200)));
  for (const [word, state] of [[6, 0x21], [7, 0x23], [15, 0x27]]) {
    await client.writeRegister(CONTROL, word);
    await until(`in state ${state}`, (status) => (status & 0x6f) === state);
  }
  await client.writeRegister(MODE, 1);
  await client.writeRegisters(TARGET, pair(-2500));
  await client.writeRegisters(SPEED, pair(100000));
  await client.writeRegisters(ACCELERATION, [...pair(2000000), ...pair(2000000)]);
  await client.writeRegister(CONTROL, 0x1f);
  await until("given its set-point", (status) => (status & 0x1000) !== 0);
  await client.writeRegister(CONTROL, 0x0f);
  // "Target reached" alone is stale until the motion starts.
  await until("at its target", (status, at) => (status & 0x1400) === 0x0400 && Math.abs(at + 2500) <= 5);
  console.log("moved");
  client.close(() => {});
}

main().catch((error) => {
  console.log("failed:", error.message || error);
  process.exit(1);
});
