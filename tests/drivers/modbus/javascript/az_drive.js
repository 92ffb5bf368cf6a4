// An Oriental Motor AZ as far as a settled move needs it, on the server of modbus-serial: a peer that is not fvd's, and
// a drive that takes its time. Prints the port it listens on, then serves until it is ended.
"use strict";

const { ServerTCP } = require("modbus-serial");

const DIRECT_TYPE = 0x5a;
const TARGET = 0x5c;
const SPEED = 0x5e;
const TRIGGER = 0x66;
const AUTO_OFF = 0x78;
const OUTPUT = 0x7e;
const POSITION = 0xcc;
const REGISTERS = 0x400;
const HOME = 1 << 4;
const STOP = 1 << 5;
const HOME_END = 1 << 4;
const READY = 1 << 5;
const MOVE = 1 << 13;
const IN_POSITION = 1 << 14;
const ILLEGAL_ADDRESS = { modbusErrorCode: 2 };

const registers = new Uint16Array(REGISTERS);
let homed = false;
let motion = { from: 0, to: 0, begin_ms: 0, duration_ms: 0 };

const value = (at) => (registers[at] << 16) | registers[at + 1];
const setValue = (at, number) => {
  registers[at] = number >>> 16;
  registers[at + 1] = number & 0xffff;
};

const progress = () => {
  if (motion.duration_ms === 0) return 1;
  return Math.min(1, (performance.now() - motion.begin_ms) / motion.duration_ms);
};
const position = () => Math.round(motion.from + (motion.to - motion.from) * progress());

function moveTo(target, stepsPerSecond) {
  const from = position();
  motion = { from, to: target, begin_ms: performance.now(), duration_ms: (1000 * Math.abs(target - from)) / stepsPerSecond };
}

function act() {
  if (value(AUTO_OFF) & HOME) {
    motion = { from: 0, to: 0, begin_ms: 0, duration_ms: 0 };
    homed = true;
  }
  if (value(AUTO_OFF) & STOP) moveTo(position(), 1);
  setValue(AUTO_OFF, 0);
  if (value(TRIGGER) === 1) {
    if (value(DIRECT_TYPE) === 1 && value(SPEED) > 0) moveTo(value(TARGET), value(SPEED));
    setValue(TRIGGER, 0);
  }
}

const server = new ServerTCP(
  {
    getHoldingRegister: (address, unit, done) => readAll(address, 1, (error, values) => done(error, values && values[0])),
    getMultipleHoldingRegisters: (address, count, unit, done) => readAll(address, count, done),
    setRegister: (address, word, unit, done) => writeAll(address, [word], done),
    setRegisterArray: (address, words, unit, done) => writeAll(address, words, done),
  },
  { host: "127.0.0.1", port: "0", unitID: 1 },
);

function readAll(address, count, done) {
  if (address + count > REGISTERS) return done(ILLEGAL_ADDRESS);
  const moving = progress() < 1;
  setValue(POSITION, position());
  setValue(OUTPUT, READY | (homed ? HOME_END : 0) | (moving ? MOVE : IN_POSITION));
  return done(null, Array.from(registers.slice(address, address + count)));
}

function writeAll(address, words, done) {
  if (address + words.length > REGISTERS) return done(ILLEGAL_ADDRESS);
  registers.set(words, address);
  act();
  return done(null);
}

server.on("initialized", () => console.log(server._server.address().port));
