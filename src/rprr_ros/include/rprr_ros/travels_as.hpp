// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

/// Lets a core struct travel on a topic of its robot: as a shared pointer between nodelets of one
/// manager, without any copy, and as the message given between processes. What listens with the
/// message's own type (rostopic, rosbag, Python) gets that message.
///
/// Needs, found by argument-dependent lookup, for Struct and Message:
///   Message to_message(const Struct&);
///   void from_message(const Message&, Struct&);
/// from_message reports what makes no sense inside of the struct: it must not throw. At file scope,
/// outside of any namespace.
#define RPRR_TRAVELS_AS(Struct, Message)                                \
  namespace ros {                                                       \
  namespace message_traits {                                            \
  template <>                                                           \
  struct IsMessage<Struct> : TrueType {};                               \
  template <>                                                           \
  struct IsMessage<Struct const> : TrueType {};                         \
  template <>                                                           \
  struct MD5Sum<Struct> {                                               \
    static const char* value() { return MD5Sum<Message>::value(); }     \
    static const char* value(const Struct&) { return value(); }         \
  };                                                                    \
  template <>                                                           \
  struct DataType<Struct> {                                             \
    static const char* value() { return DataType<Message>::value(); }   \
    static const char* value(const Struct&) { return value(); }         \
  };                                                                    \
  template <>                                                           \
  struct Definition<Struct> {                                           \
    static const char* value() { return Definition<Message>::value(); } \
    static const char* value(const Struct&) { return value(); }         \
  };                                                                    \
  }                                                                     \
  namespace serialization {                                             \
  template <>                                                           \
  struct Serializer<Struct> {                                           \
    template <typename Stream>                                          \
    static void write(Stream& stream, const Struct& value) {            \
      stream.next(to_message(value));                                   \
    }                                                                   \
    template <typename Stream>                                          \
    static void read(Stream& stream, Struct& value) {                   \
      Message message;                                                  \
      stream.next(message);                                             \
      from_message(message, value);                                     \
    }                                                                   \
    static std::uint32_t serializedLength(const Struct& value) {        \
      return serializationLength(to_message(value));                    \
    }                                                                   \
  };                                                                    \
  }                                                                     \
  }
